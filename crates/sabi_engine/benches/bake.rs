//! `cargo bench`: the numbers that say whether Sabi is fast. Medians of a few runs; nothing here asserts.
//!
//! The model is that of [`setup::peer_model`].

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

#[path = "setup/bakes.rs"]
mod bakes;
#[path = "bake/card.rs"]
mod card;
mod setup;
#[path = "bake/surface.rs"]
mod surface;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bakes::{graph, request};
use sabi_engine::baking::{BakeRequest, bake};
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use serde_json::{Value as Json, json};
use setup::{adapter, peer_model, root};

/// Simplex noise of eight octaves, cells, levels, two blends and an effect.
const PEER_NODES: &str = r#"
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.2, "octaves": 8 } },
    "cells": { "kind": "noise/cells", "params": { "size": 0.1 } },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "clouds" }, "params": { "black": 0.2 } },
    "both": { "kind": "blend/mask", "inputs": { "below": "levels", "above": "cells" } },
    "all": { "kind": "blend/mask", "inputs": { "below": "both", "above": "clouds" }, "params": { "mode": "screen" } },
    "base": { "kind": "source/material" },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "all" } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } }"#;

fn bake_once(graph: &Path, model: &Path, folder: &Path, size: u32, fuse: bool, cache: Option<PathBuf>) -> Json {
    let mut model = ModelOptions::new(model, size);
    model.cache_dir = cache;
    let request = BakeRequest {
        fuse,
        ..request(folder, graph, model, adapter())
    };
    let started = Instant::now();
    let mut json = serde_json::to_value(bake(&request, &NoProgress).unwrap()).unwrap();
    json["whole_ms"] = json!(started.elapsed().as_secs_f64() * 1000.0);
    json
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn seconds(work: impl Fn() -> Duration) -> f64 {
    median((0..5).map(|_| work().as_secs_f64()).collect())
}

fn row(what: &str, value: f64, unit: &str, aim: &str) {
    println!("| {what} | {value:.3} {unit} | {aim} |");
}

/// A hundred masks in a row.
fn chain() -> String {
    let mut nodes = r#""n00": { "kind": "noise/simplex" }"#.to_owned();
    for node in 1..100 {
        let before = node - 1;
        let _ = write!(
            nodes,
            r#", "n{node:02}": {{ "kind": "adjust/invert", "inputs": {{ "source": "n{before:02}" }} }}"#
        );
    }
    nodes + r#", "out": { "kind": "output/mask", "inputs": { "source": "n99" } }"#
}

/// Returns a hundred nodes in which every mask is read by two nodes: material layers over a net of blends.
fn branches() -> String {
    let mut nodes =
        r#""m00": { "kind": "noise/simplex" }, "m01": { "kind": "noise/cells" }, "l00": { "kind": "source/material" }"#
            .to_owned();
    for node in 2..50 {
        let (one, two) = (node - 1, node - 2);
        let _ = write!(
            nodes,
            r#", "m{node:02}": {{ "kind": "blend/mask", "inputs": {{ "below": "m{one:02}", "above": "m{two:02}" }} }}"#
        );
    }
    for node in 1..50 {
        let before = node - 1;
        let _ = write!(
            nodes,
            r#", "l{node:02}": {{ "kind": "effect/layer", "inputs": {{ "base": "l{before:02}", "mask": "m{node:02}" }} }}"#
        );
    }
    nodes + r#", "out": { "kind": "output/material", "inputs": { "material": "l49" } }"#
}

fn bench_run(folder: &Path, model: &Path) {
    let peer = graph(folder, "peer.sabi", PEER_NODES);
    let run = |fuse| {
        let once = || {
            bake_once(&peer, model, folder, 2048, fuse, None)["stages_ms"]["run"]
                .as_f64()
                .unwrap()
        };
        median((0..5).map(|_| once()).collect()) / 1000.0
    };
    let fused = run(true);
    row(
        "run: simplex, cells, levels, 2 blends, effect at 2048²",
        fused,
        "s",
        "≤ 0.45 s",
    );
    row("the same without fusion, as a multiple", run(false) / fused, "×", "");
}

/// Measures each noise alone over many points: the best of nine runs, which other work affects least.
fn bench_noises(folder: &Path, model: &Path) {
    for (kind, aim) in [
        ("simplex", "≤ 60 ms"),
        ("cells", "≤ 60 ms"),
        ("cracks", "≤ 60 ms"),
        ("dots", ""),
        ("scratches", "≤ 60 ms"),
    ] {
        let nodes = format!(
            r#""noise": {{ "kind": "noise/{kind}" }}, "out": {{ "kind": "output/mask", "inputs": {{ "source": "noise" }} }}"#
        );
        let graph = graph(folder, "noise.sabi", &nodes);
        let once = || {
            bake_once(&graph, model, folder, 1024, true, None)["nodes_ms"]["noise"]
                .as_f64()
                .unwrap()
        };
        let best = (0..9).map(|_| once()).fold(f64::INFINITY, f64::min);
        row(&format!("noise/{kind} alone at 1024²"), best, "ms", aim);
    }
}

fn bench_atlas(folder: &Path, model: &Path) {
    let options = ModelOptions::new(model, 2048);
    let atlas = |cache: Option<PathBuf>| {
        let loaded = LinkedModel::load_model(&options, &NoProgress).unwrap();
        let options = ModelOptions {
            cache_dir: cache,
            ..options.clone()
        };
        let started = Instant::now();
        LinkedModel::link(loaded, &options, &NoProgress).unwrap();
        started.elapsed()
    };
    row("linked atlas at 2048², cold", seconds(|| atlas(None)), "s", "≤ 0.6 s");
    let cache = folder.join("cache");
    atlas(Some(cache.clone()));
    row(
        "the same from the disk cache",
        seconds(|| atlas(Some(cache.clone()))),
        "s",
        "≤ 0.05 s",
    );
}

fn bench_demo(folder: &Path) {
    let demo = root().join("tests/graphs/weathered-bench.sabi");
    let bench = root().join("assets/meshes/bench.glb");
    let once = || {
        bake_once(&demo, &bench, folder, 1024, true, None)["whole_ms"]
            .as_f64()
            .unwrap()
    };
    let whole = median((0..3).map(|_| once()).collect());
    row(
        "the demo at 1024², atlas not cached, device opened anew",
        whole / 1000.0,
        "s",
        "≤ 4 s",
    );
}

fn bench_memory(folder: &Path, model: &Path) {
    for (what, nodes) in [
        ("a chain of 100 nodes", chain()),
        ("100 nodes with branches", branches()),
    ] {
        let graph = graph(folder, "hundred.sabi", &nodes);
        let report = bake_once(&graph, model, folder, 2048, false, None);
        let mib = report["peak_texture_bytes"].as_f64().unwrap() / f64::from(1 << 20);
        row(
            &format!("textures of {what} at 2048², not fused"),
            mib,
            "MiB",
            "≤ 300 MiB",
        );
    }
}

/// Measures planning of four thousand masks, each read by two nodes: the time must grow with their number, not with its square.
fn bench_planning(folder: &Path) {
    let mut nodes = r#""m0": { "kind": "noise/simplex" }, "m1": { "kind": "noise/cells" }"#.to_owned();
    for node in 2..4000 {
        let (one, two) = (node - 1, node - 2);
        let _ = write!(
            nodes,
            r#", "m{node}": {{ "kind": "blend/mask", "inputs": {{ "below": "m{one}", "above": "m{two}" }} }}"#
        );
    }
    let nodes = nodes + r#", "out": { "kind": "output/mask", "inputs": { "source": "m3999" } }"#;
    let graph = graph(folder, "ladder.sabi", &nodes);
    let check = || {
        let started = Instant::now();
        assert!(sabi_engine::catalog::check::check(&graph).unwrap().errors.is_empty());
        started.elapsed()
    };
    row("reading, checking and planning 4 000 nodes", seconds(check), "s", "");
}

/// Measures whole bakes at 1024² of models with a million triangles, with nothing cached. Models whose file is missing are skipped.
fn bench_millions(folder: &Path) {
    let peer = graph(folder, "peer.sabi", PEER_NODES);
    let spheres = "../shared/data/meshes/khr-MetalRoughSpheresNoTextures/glTF/MetalRoughSpheresNoTextures.gltf";
    for (what, file, advice, aim) in [
        (
            "1.1 million triangles with UVs: the whole bake",
            "target/meshes/figure-million.glb",
            "`cargo xtask assets --million` writes it",
            "< 15 s",
        ),
        (
            "1 million triangles, 98 materials, no UVs: the whole bake",
            spheres,
            "it is in the shared data folder",
            "< 60 s",
        ),
    ] {
        let model = root().join(file);
        if !model.is_file() {
            println!("| {what} | left out: {advice} | {aim} |");
            continue;
        }
        let report = bake_once(&peer, &model, folder, 1024, true, None);
        row(what, report["whole_ms"].as_f64().unwrap() / 1000.0, "s", aim);
    }
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let model = peer_model();
    // `cargo bench --bench bake -- rays filters` runs only these.
    let named: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with('-')).collect();
    let is_wanted = |name: &str| named.is_empty() || named.iter().any(|wanted| wanted == name);
    println!("| what | measured | aim |\n|---|---|---|");
    let parts: [(&str, &dyn Fn()); 11] = [
        ("run", &|| bench_run(folder.path(), &model)),
        ("noises", &|| bench_noises(folder.path(), &model)),
        ("rays", &|| surface::bench_rays(folder.path(), &model)),
        ("filters", &|| surface::bench_filters(folder.path(), &model)),
        ("ghosts", &|| surface::bench_ghosts(folder.path(), &model)),
        ("atlas", &|| bench_atlas(folder.path(), &model)),
        ("demo", &|| bench_demo(folder.path())),
        ("planning", &|| bench_planning(folder.path())),
        ("memory", &|| bench_memory(folder.path(), &model)),
        ("millions", &|| bench_millions(folder.path())),
        ("card", &|| card::bench(folder.path(), &model)),
    ];
    for (_, bench) in parts.iter().filter(|(name, _)| is_wanted(name)) {
        bench();
    }
}
