//! Measurements at 4096², for a graphics card. A software driver would take minutes.

use std::path::Path;

use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use sabi_gpu::{AdapterKind, Gpu};

use super::setup::{adapter, root};
use super::{bake_once, graph, row};

const SIZE: u32 = 4096;
const RAYS: u32 = 64;
const STAGES: [&str; 5] = ["load", "atlas", "compile", "run", "encode"];

/// Measures rays per second of occlusion with many rays, including everything that its node does.
fn bench_occlusion(folder: &Path, model: &Path) {
    let linked = LinkedModel::open(&ModelOptions::new(model, SIZE), &NoProgress).unwrap();
    let owned = linked.atlas.owners.iter().filter(|&&owner| owner >> 31 == 0).count();
    let nodes = format!(
        r#""rays": {{ "kind": "surface/occlusion", "params": {{ "rays": {RAYS} }} }},
           "out": {{ "kind": "output/mask", "inputs": {{ "source": "rays" }} }}"#
    );
    let graph = graph(folder, "rays.sabi", &nodes);
    let once = || {
        bake_once(&graph, model, folder, SIZE, true, None)["nodes_ms"]["rays"]
            .as_f64()
            .unwrap()
    };
    let seconds = (0..3).map(|_| once()).fold(f64::INFINITY, f64::min) / 1000.0;
    row(&format!("occlusion, {RAYS} rays, at {SIZE}²"), seconds, "s", "");
    let rays = owned as f64 * f64::from(RAYS);
    row("the same, rays a second", rays / seconds / 1e9, "G", "≥ 1 G");
}

/// Measures each stage of the demo's maps. The atlas comes from the disk, as in the second bake of a graph.
fn bench_maps(folder: &Path) {
    let demo = root().join("tests/graphs/weathered-bench.sabi");
    let bench = root().join("assets/meshes/bench.glb");
    let once = || bake_once(&demo, &bench, folder, SIZE, true, Some(folder.join("cache")));
    once();
    let whole = |report: &serde_json::Value| report["whole_ms"].as_f64().unwrap();
    let runs = [once(), once(), once()];
    let best = runs
        .iter()
        .min_by(|one, other| whole(one).total_cmp(&whole(other)))
        .unwrap();
    let maps = best["outputs"].as_array().unwrap().len();
    row(
        &format!("{maps} maps of the demo at {SIZE}², device opened anew"),
        whole(best) / 1000.0,
        "s",
        "",
    );
    for stage in STAGES {
        let seconds = best["stages_ms"][stage].as_f64().unwrap() / 1000.0;
        let aim = if stage == "run" { "≤ 1 s" } else { "" };
        row(&format!("… of which {stage}"), seconds, "s", aim);
    }
}

pub(crate) fn bench(folder: &Path, model: &Path) {
    let summary = Gpu::open(&adapter()).unwrap().summary().clone();
    if summary.kind == AdapterKind::Cpu {
        println!(
            "| {SIZE}²: maps and rays | left out: {} is a software driver | |",
            summary.name
        );
        return;
    }
    bench_occlusion(folder, model);
    bench_maps(folder);
}
