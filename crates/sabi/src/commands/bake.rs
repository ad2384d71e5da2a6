//! `sabi bake`: a graph on a model becomes a PBR set.

use std::time::Instant;

use sabi_engine::{BakeReport, BakeRequest, bake, bake_graph, default_preset_folder};

use crate::arguments::BakeArguments;
use crate::exit::{Exit, Failure};
use crate::failed_bake::FailedBake;
use crate::failure_report::FailureReport;
use crate::progress::Bars;
use crate::report_file::ReportFile;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &BakeArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let started = Instant::now();
    let report_file = match &arguments.report {
        Some(path) => Some(ReportFile::create(
            path,
            &arguments.output,
            &arguments.evaluation.inputs(),
        )?),
        None => None,
    };
    let report = match baked(arguments, terminal) {
        Ok(report) => report,
        Err(failure) => return Err(reported(failure, arguments, report_file, terminal)),
    };
    for warning in &report.warnings {
        terminal.warning(warning);
    }
    if let Some(file) = report_file.filter(|file| !file.is_stdout()) {
        file.write(&report, terminal)?;
    }
    if arguments.prints_report() {
        terminal.json(&report)?;
    } else {
        let paths = report.files.iter().map(|file| arguments.output.join(file));
        let lines: String = paths.map(|path| format!("{}\n", path.display())).collect();
        terminal.data(&lines)?;
    }
    summarize(arguments, &report, started, terminal);
    Ok(Exit::Done)
}

fn baked(arguments: &BakeArguments, terminal: &Terminal) -> Result<BakeReport, Failure> {
    let request = request(arguments)?;
    let piped = arguments.evaluation.graph.piped()?;
    let bars = Bars::new(terminal);
    match piped {
        Some((open, kinds)) => Ok(bake_graph(&open, &kinds, &request, &bars)?),
        None => Ok(bake(&request, &bars)?),
    }
}

/// Adds the bake to a failure, and writes it as the report. One that the user stopped leaves an earlier report as it is, like the maps.
fn reported(mut failure: Failure, arguments: &BakeArguments, file: Option<ReportFile>, terminal: &Terminal) -> Failure {
    let evaluation = &arguments.evaluation;
    failure.bake = Some(Box::new(FailedBake::new(evaluation.graph.path(), &evaluation.mesh)));
    if let Some(file) = file.filter(|file| !file.is_stdout() && failure.exit != Exit::Interrupted) {
        let report = FailureReport::new(&failure, terminal.command());
        if let Err(unwritten) = file.write_failure(&report, terminal) {
            terminal.failure_in_words(&unwritten);
        }
    }
    failure
}

fn request(arguments: &BakeArguments) -> Result<BakeRequest, Failure> {
    Ok(BakeRequest {
        graph: arguments.evaluation.graph.path().to_owned(),
        evaluator: arguments.evaluation.options(arguments.maps.size)?,
        output: arguments.output.clone(),
        presets: arguments.preset.clone(),
        preset_folder: default_preset_folder(),
        names: arguments.names.clone(),
        channels: arguments.channel.clone(),
        mesh_maps: arguments.mesh_map.clone(),
        material: arguments.evaluation.material.clone(),
        all_maps: arguments.all_maps,
        padding: arguments.padding_texels(),
        seams: arguments.seams.into(),
        fuse: !arguments.no_fuse,
        force: arguments.force,
        model: arguments.copy_options(),
        report: arguments.report.clone().filter(|path| path.as_os_str() != "-"),
    })
}

fn summarize(arguments: &BakeArguments, report: &BakeReport, started: Instant, terminal: &Terminal) {
    let counted = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let mut count = counted(report.outputs.len(), "map", "maps");
    if let Some(model) = &report.model {
        count = format!("{count} and {}", model.copy.path);
    }
    let size = arguments.maps.size;
    terminal.note(format_args!(
        "Baked {} on {} at {size} × {size}: {count} in {}, in {:.2} s",
        arguments.evaluation.graph.path().display(),
        arguments.evaluation.mesh.display(),
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
    for constant in &report.constants {
        terminal.note(format_args!(
            "  constant   {} {} {}",
            constant.material,
            constant.channel.name(),
            constant.value
        ));
    }
}
