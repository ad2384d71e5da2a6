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

/// One fact a line, then one version a line.
fn table(report: &StrokeReport) -> String {
    let facts = [
        ("model", report.model.clone()),
        ("bytes", report.bytes.to_string()),
        ("steps", report.steps.to_string()),
        ("damaged bytes", report.damaged_bytes.to_string()),
    ];
    let facts = facts.map(|(name, value)| format!("{name:24} {value}\n")).concat();
    let versions = report.versions.iter().map(|version| {
        let what = match version.strokes {
            Some(strokes) => format!("{strokes} strokes, {} points", version.points),
            None => "steps are lost".to_owned(),
        };
        format!("version {:16} {what}\n", version.version)
    });
    facts + &versions.collect::<String>()
}
