//! Time from nothing to a first picture, and until nothing is outstanding.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sabi_gpu::AdapterChoice;

use crate::table::{ms, row};
use crate::{asset, opened};

/// Measures the time until the first picture of the graph that the program comes with.
pub(crate) fn start(adapter: &AdapterChoice) {
    let [graph, model] = ["tests/graphs/weathered-bench.sabi", "assets/meshes/bench.glb"].map(asset);
    let began = Instant::now();
    let mut window = opened(adapter, &graph.display().to_string(), model);
    while window.drawn().0 == 0 {
        window.frame(Vec::new());
        window.wait(Duration::from_millis(50));
    }
    window.finish().unwrap();
    row(
        "a window opens: the first picture is drawn",
        vec![ms(began.elapsed())],
        "≤ 3000 ms",
    );
    window.rest();
    row("… and all of it is there", vec![ms(began.elapsed())], "");
}

/// Ten nodes on a textured model as artists stack them, from a cold cache: rays, curvature, noises, a filter and two layers.
pub(crate) fn settle(adapter: &AdapterChoice, folder: &Path, what: &str, model: PathBuf) {
    let graph = folder.join("helmet.sabi");
    std::fs::write(&graph, TEN).unwrap();
    let began = Instant::now();
    let mut window = opened(adapter, &graph.display().to_string(), model);
    while window.drawn().0 == 0 {
        window.frame(Vec::new());
        window.wait(Duration::from_millis(50));
    }
    window.finish().unwrap();
    row(
        &format!("{what} with ten nodes at 512²: the first picture"),
        vec![ms(began.elapsed())],
        "",
    );
    window.rest();
    row("… and all of it is there", vec![ms(began.elapsed())], "≤ 8000 ms");
    for (what, value) in [("an edit of its rays", 0.3), ("another one", 0.4)] {
        let edited = Instant::now();
        window.turn("shade", "distance", value, false);
        window.rest();
        row(&format!("… after {what}, settled"), vec![ms(edited.elapsed())], "");
    }
}

const TEN: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 512 }, "nodes": {
    "base": { "kind": "source/model", "pos": [0, 240] },
    "edges": { "kind": "surface/edges", "pos": [0, 0] },
    "shade": { "kind": "surface/occlusion", "pos": [0, 120] },
    "clouds": { "kind": "noise/simplex", "pos": [240, 0] },
    "worn": { "kind": "blend/mask", "inputs": { "below": "edges", "above": "clouds" }, "pos": [480, 0] },
    "soft": { "kind": "filter/blur", "inputs": { "source": "worn" }, "pos": [720, 0] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "soft" },
      "params": { "color": "#6b3a1e" }, "pos": [960, 0] },
    "dirt": { "kind": "adjust/invert", "inputs": { "source": "shade" }, "pos": [480, 120] },
    "dirty": { "kind": "effect/layer", "inputs": { "base": "rust", "mask": "dirt" },
      "params": { "color": "#2b2620" }, "pos": [1200, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "dirty" }, "pos": [1440, 0] } } }"##;
