//! `sabi bake`: a graph on a model becomes a PBR set.

use std::time::Instant;

use sabi_engine::{BakeReport, BakeRequest, bake};

use crate::arguments::BakeArguments;
use crate::exit::{Exit, Failure};
use crate::progress::Bars;
use crate::report_file::ReportFile;
use crate::terminal::{Terminal, plain};

pub(crate) fn run(arguments: &BakeArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let started = Instant::now();
    let request = request(arguments)?;
    let report_file = match &arguments.report {
        Some(path) => Some(ReportFile::create(
            path,
            &arguments.output,
            &[&arguments.workpiece.graph, &arguments.workpiece.mesh],
        )?),
        None => None,
    };
    let bars = Bars::new(terminal);
    let report = bake(&request, &bars)?;
    drop(bars);
    for warning in &report.warnings {
        terminal.warning(warning);
    }
    let prints_report = arguments.json || report_file.as_ref().is_some_and(ReportFile::is_stdout);
    if let Some(file) = report_file.filter(|file| !file.is_stdout()) {
        file.write(&report.json, terminal)?;
    }
    if prints_report {
        terminal.json(&report.json)?;
    } else {
        let paths = report.files.iter().map(|file| arguments.output.join(file));
        let lines: String = paths.map(|path| format!("{}\n", path.display())).collect();
        terminal.data(&lines)?;
    }
    summarize(arguments, &report, started, terminal);
    Ok(Exit::Done)
}

fn request(arguments: &BakeArguments) -> Result<BakeRequest, Failure> {
    Ok(BakeRequest {
        graph: arguments.workpiece.graph.clone(),
        evaluator: arguments.workpiece.options(arguments.maps.size)?,
        output: arguments.output.clone(),
        presets: arguments.preset.clone(),
        names: arguments.names.clone(),
        channels: arguments.channel.clone(),
        material: arguments.workpiece.material.clone(),
        all_maps: arguments.all_maps,
        padding: arguments.padding_texels(),
        seams: arguments.seams.into(),
        fuse: !arguments.no_fuse,
        force: arguments.force,
        model: arguments.copies_model,
        report: arguments.report.clone().filter(|path| path.as_os_str() != "-"),
    })
}

fn summarize(arguments: &BakeArguments, report: &BakeReport, started: Instant, terminal: &Terminal) {
    let (json, times) = (&report.json, &report.times);
    let counted = |count: u64, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let maps = json["outputs"].as_array().map_or(0, Vec::len);
    let mut count = counted(maps as u64, "map", "maps");
    if let Some(copy) = json["model"]["path"].as_str() {
        count = format!("{count} and {copy}");
    }
    let number = |key: &str| json[key].as_u64().unwrap_or(0);
    let size = arguments.maps.size;
    terminal.note(format_args!(
        "Baked {} on {} at {size} × {size}: {count} in {}, in {:.2} s",
        arguments.workpiece.graph.display(),
        arguments.workpiece.mesh.display(),
        arguments.output.display(),
        started.elapsed().as_secs_f64(),
    ));
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
        counted(number("nodes"), "node", "nodes"),
        counted(number("passes"), "pass", "passes"),
        number("peak_texture_bytes").div_ceil(1 << 20),
    ));
    terminal.note(format_args!(
        "  adapter    {} ({})",
        json["adapter"]["name"].as_str().unwrap_or_default(),
        json["adapter"]["kind"].as_str().unwrap_or_default(),
    ));
    for constant in json["constants"].as_array().into_iter().flatten() {
        terminal.note(format_args!("  constant   {}", in_words(constant)));
    }
}

/// A channel that is the same all over.
fn in_words(constant: &serde_json::Value) -> String {
    let word = |key: &str| constant[key].as_str().unwrap_or_default();
    let (material, channel) = (word("material"), word("channel"));
    format!("{material} {channel} {}", plain(&constant["value"]))
}
