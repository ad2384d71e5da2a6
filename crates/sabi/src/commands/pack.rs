//! `sabi pack`: a graph with all files that its bake reads, in one archive.

use sabi_engine::packing::{PackReport, PackRequest, PackedModel, pack_graph};
use sabi_files::TrustedPaths;

use crate::arguments::PackArguments;
use crate::exit::{Exit, Failure};
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &PackArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let graph = arguments.graph.file("the files of a graph are found from its folder")?;
    let request = PackRequest {
        graph: graph.to_owned(),
        model: match &arguments.mesh {
            _ if arguments.no_mesh => PackedModel::None,
            Some(mesh) => PackedModel::File(mesh.clone()),
            None => PackedModel::OfGraph,
        },
        reading: arguments.reading.reading(),
        output: arguments.output.clone(),
        allows_missing: arguments.allow_missing,
        replaces: arguments.force,
        trusted: arguments.reading.trusted(trusted),
    };
    let progress = ShownProgress::new(terminal);
    let report = pack_graph(&request, &progress)?;
    drop(progress);
    terminal.warnings(report.missing.iter().chain(&report.warnings).map(String::as_str));
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.paths([&arguments.output])?;
    }
    summarize(arguments, &report, terminal);
    Ok(Exit::Done)
}

fn summarize(arguments: &PackArguments, report: &PackReport, terminal: &Terminal) {
    let bytes: u64 = report.files.iter().map(|file| file.bytes).sum();
    terminal.note(format_args!(
        "Packed {}: {} files of {:.1} MiB",
        arguments.graph.path().display(),
        report.files.len(),
        bytes as f64 / f64::from(1 << 20),
    ));
    // Files from other folders are listed, since they may be private.
    for file in &report.files {
        if let Some(from) = &file.from {
            terminal.note(format_args!("  {} from {from}", file.name));
        }
    }
}
