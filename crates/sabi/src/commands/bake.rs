//! `sabi bake`: a graph on a model becomes a PBR set.

use std::time::Instant;

use sabi_engine::baking::BakeReport;
use sabi_engine::baking::recorded::{FinishedBake, RecordedBake};
use sabi_files::TrustedPaths;

use crate::arguments::BakeArguments;
use crate::exit::{Exit, Failure};
use crate::failed_bake::FailedBake;
use crate::failure_report::FailureReport;
use crate::report_file::ReportFile;
use crate::requested_bake::{BakeOutcome, RequestedBake};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &BakeArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let started = Instant::now();
    let asked = RequestedBake::of(arguments)?;
    let report_file = match &arguments.report {
        Some(path) => Some(ReportFile::create(path, &arguments.output, &asked.inputs(arguments))?),
        None => None,
    };
    match asked.bake(arguments, trusted, terminal) {
        Ok(BakeOutcome::Now(report)) => {
            tell(arguments, &report, report_file, terminal)?;
            summarize(arguments, &asked, &report, started, terminal);
            Ok(match &asked {
                RequestedBake::New { .. } => Exit::Done,
                RequestedBake::Recorded { bake, .. } => compare(bake, &report, terminal),
            })
        }
        Ok(BakeOutcome::Before(finished)) => {
            tell_finished(arguments, &finished, report_file, terminal)?;
            Ok(Exit::Done)
        }
        Err(failure) => Err(reported(failure, &asked, report_file, terminal)),
    }
}

/// Prints the warnings and files of a bake, and writes its report.
fn tell(
    arguments: &BakeArguments,
    report: &BakeReport,
    report_file: Option<ReportFile>,
    terminal: &Terminal,
) -> Result<(), Failure> {
    terminal.warnings(&report.warnings);
    if let Some(file) = report_file.filter(|file| !file.is_stdout()) {
        let placed = report.placed(&file.base());
        file.write(&placed, terminal)?;
    }
    if arguments.prints_report() {
        terminal.json(report)
    } else {
        list(arguments, report.files.iter(), terminal)
    }
}

/// Prints the warnings and files of a bake whose maps existed already, and writes its report.
fn tell_finished(
    arguments: &BakeArguments,
    finished: &FinishedBake,
    report_file: Option<ReportFile>,
    terminal: &Terminal,
) -> Result<(), Failure> {
    terminal.warnings(finished.warnings());
    if let Some(file) = report_file.filter(|file| !file.is_stdout()) {
        let placed = finished.report(Some(&file.base()))?;
        file.write(&placed, terminal)?;
    }
    let files = finished.files();
    if arguments.prints_report() {
        terminal.json(&finished.report(None)?)?;
    } else {
        list(arguments, files.iter(), terminal)?;
    }
    terminal.note(format_args!(
        "Nothing to do: {} in {} of this very bake are up to date; --again bakes all the same",
        counted(files.len(), "file", "files"),
        arguments.output.display(),
    ));
    Ok(())
}

/// Prints the paths of files, one a line.
fn list<'a>(
    arguments: &BakeArguments,
    files: impl Iterator<Item = &'a String>,
    terminal: &Terminal,
) -> Result<(), Failure> {
    let paths = files.map(|file| arguments.output.join(file));
    terminal.paths(paths)
}

/// Prints whether the maps of a bake have the same bytes as those that a report records.
fn compare(recorded: &RecordedBake, report: &BakeReport, terminal: &Terminal) -> Exit {
    let differences = recorded.differences(report);
    for difference in &differences {
        terminal.error(difference);
    }
    if !differences.is_empty() {
        return Exit::Mismatch;
    }
    let files = counted(report.written_files().count(), "file", "files");
    terminal.note(format_args!("  report     {files}, all with the bytes that it records"));
    Exit::Done
}

/// Adds the bake to a failure, and writes it as the report. If the user stopped the bake, an earlier report stays as it is, like the maps.
fn reported(mut failure: Failure, asked: &RequestedBake<'_>, file: Option<ReportFile>, terminal: &Terminal) -> Failure {
    failure.bake = Some(Box::new(FailedBake::new(&asked.graph(), &asked.mesh())));
    if let Some(file) = file.filter(|file| !file.is_stdout() && failure.exit != Exit::Interrupted) {
        let report = FailureReport::new(&failure, terminal.command());
        if let Err(unwritten) = file.write_failure(&report, terminal) {
            terminal.failure_in_words(&unwritten);
        }
    }
    failure
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn summarize(
    arguments: &BakeArguments,
    asked: &RequestedBake<'_>,
    report: &BakeReport,
    started: Instant,
    terminal: &Terminal,
) {
    let mut count = counted(report.outputs.len(), "map", "maps");
    let documents = report.documents.iter().map(|document| &document.path);
    let named: Vec<&String> = documents
        .chain(report.model.as_ref().map(|model| &model.copy.path))
        .collect();
    for (at, name) in named.iter().enumerate() {
        let joint = if at + 1 == named.len() { " and" } else { "," };
        count = format!("{count}{joint} {name}");
    }
    let size = asked.size(arguments);
    terminal.note(format_args!(
        "Baked {} on {} at {size} × {size}: {count} in {}, in {:.2} s",
        asked.graph().display(),
        asked.mesh().display(),
        arguments.output.display(),
        started.elapsed().as_secs_f64(),
    ));
    let times = &report.times;
    let stages = [
        ("load", times.load),
        ("atlas", times.atlas),
        ("compile", times.compile),
        ("run", times.run),
        ("encode", times.encode),
    ];
    let stages = stages.map(|(name, time)| format!("{name} {:.2} s", time.total().as_secs_f64()));
    terminal.note(format_args!("  stages     {}", stages.join(", ")));
    terminal.note(format_args!(
        "  graph      {} in {}, {} MiB of textures",
        counted(report.nodes, "node", "nodes"),
        counted(report.passes, "pass", "passes"),
        report.peak_texture_bytes.div_ceil(1 << 20),
    ));
    if let Some(memory) = report.engine.sentence() {
        terminal.note(format_args!("  maps       {memory}"));
    }
    terminal.note(format_args!(
        "  adapter    {} ({})",
        report.adapter.name, report.adapter.kind
    ));
    for output in &report.outputs {
        if let Some([low, high]) = output.range {
            terminal.note(format_args!(
                "  height     {} is {low} to {high} in the model's units",
                output.path
            ));
        }
        if let Some(scale) = output.scale {
            terminal.note(format_args!("  emission   {} times {scale}", output.path));
        }
    }
    for constant in &report.constants {
        terminal.note(format_args!(
            "  constant   {} {} {}",
            constant.material,
            constant.channel.name(),
            constant.value
        ));
    }
}
