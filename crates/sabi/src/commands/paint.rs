//! `sabi paint`: files of strokes.

use sabi_engine::{StrokeReport, describe_strokes};

use crate::arguments::{PaintArguments, PaintCommand};
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &PaintArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let PaintCommand::Info(arguments) = &arguments.command;
    let report = describe_strokes(&arguments.file)?;
    if report.damaged_bytes > 0 {
        let damaged = report.damaged_bytes;
        terminal.warning(format!("{damaged} of {} bytes are damaged and left out", report.bytes));
    }
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.data(&table(&report))?;
    }
    Ok(Exit::Done)
}

/// Text with a line for each fact, and then for each version.
fn table(report: &StrokeReport) -> String {
    let facts = [
        ("model", report.model.clone()),
        ("bytes", report.bytes.to_string()),
        ("steps", report.steps.to_string()),
        ("damaged bytes", report.damaged_bytes.to_string()),
    ];
    let facts = facts.map(|(name, value)| format!("{name:24} {value}\n")).concat();
    let versions = report.versions.iter().map(|version| {
        format!(
            "version {:16} {} strokes, {} points\n",
            version.version, version.strokes, version.points
        )
    });
    facts + &versions.collect::<String>()
}
