//! `sabi paint`: files of strokes.

use sabi_engine::opening::stroke_report::{StrokeReport, describe_strokes};
use sabi_engine::stroke_maintenance::{FlattenReport, ReprojectReport, flatten_strokes, reproject_strokes};
use sabi_files::TrustedPaths;

use crate::arguments::{
    PaintArguments, PaintCommand, PaintFlattenArguments, PaintInfoArguments, PaintReprojectArguments,
};
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &PaintArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        PaintCommand::Info(arguments) => info(arguments, terminal),
        PaintCommand::Flatten(arguments) => flatten(arguments, terminal),
        PaintCommand::Reproject(arguments) => reproject(arguments, trusted, terminal),
    }
}

/// Reason why strokes need the file of their graph.
const BESIDE: &str = "strokes lie beside the file of their graph";

fn flatten(arguments: &PaintFlattenArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let report = flatten_strokes(arguments.graph.file(BESIDE)?, arguments.dry_run)?;
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.page(&flattened(&report))?;
    }
    Ok(Exit::Done)
}

fn flattened(report: &FlattenReport) -> Page {
    let files = report.files.iter().map(|file| {
        format!(
            "{:24} {} strokes, {} bytes before, {} bytes without history",
            file.model, file.strokes, file.bytes_before, file.bytes
        )
    });
    files.collect()
}

/// Texels along a side of an atlas that is not built.
const NO_SIZE: u32 = 1024;

fn reproject(
    arguments: &PaintReprojectArguments,
    trusted: &TrustedPaths,
    terminal: &Terminal,
) -> Result<Exit, Failure> {
    let model = arguments.model.options(arguments.mesh.clone(), trusted, NO_SIZE);
    let report = reproject_strokes(
        arguments.graph.file(BESIDE)?,
        &model,
        arguments.from.as_deref(),
        arguments.replace,
    )?;
    for lost in &report.lost {
        terminal.warning(format!(
            "node '{}': {} of {} places of {} are lost, since '{}' has no surface near them",
            lost.node, lost.lost, lost.points, lost.stroke, report.to
        ));
    }
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.data_line(reprojected(&report))?;
    }
    Ok(Exit::Done)
}

fn reprojected(report: &ReprojectReport) -> String {
    let ReprojectReport {
        from,
        to,
        strokes,
        points,
        ..
    } = report;
    format!("{strokes} strokes with {points} places from '{from}' on '{to}'")
}

fn info(arguments: &PaintInfoArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let report = describe_strokes(&arguments.file)?;
    if report.damaged_bytes > 0 {
        let damaged = report.damaged_bytes;
        terminal.warning(format!("{damaged} of {} bytes are damaged and left out", report.bytes));
    }
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.page(&table(&report))?;
    }
    Ok(Exit::Done)
}

/// Returns a text with a line for each fact, and then one for each version.
fn table(report: &StrokeReport) -> Page {
    let facts = [
        ("model", report.model.clone()),
        ("bytes", report.bytes.to_string()),
        ("steps", report.steps.to_string()),
        ("damaged bytes", report.damaged_bytes.to_string()),
    ];
    let facts = facts.into_iter().map(|(name, value)| format!("{name:24} {value}"));
    let versions = report.versions.iter().map(|version| {
        format!(
            "version {:16} {} strokes, {} points",
            version.version, version.strokes, version.points
        )
    });
    facts.chain(versions).collect()
}
