//! `cargo bench --bench scale`: time and memory of a bake over the size of each thing that a project has. The slope of a row is
//! the power by which a figure grows from the row before: 1 where it grows with the work, 2 where with its square.
//!
//! `SABI_SCALE=nodes,rays` measures only these.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

#[path = "setup/adapter.rs"]
mod adapter;
#[path = "setup/bakes.rs"]
mod bakes;
#[path = "scale/models.rs"]
mod models;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use adapter::adapter;
use bakes::{graph, request};
use models::Counts;
use sabi_engine::baking::bake;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::phases::NoProgress;

const PLAIN: Counts = Counts {
    triangles: 20_000,
    charts: 1,
    materials: 1,
};

/// Clouds, and a blur that walks over seams.
const FILTERED: &str = r#"
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.1, "octaves": 4 } },
    "soft": { "kind": "filter/blur", "inputs": { "source": "clouds" }, "params": { "radius": 0.02 } },
    "base": { "kind": "source/material" },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "soft" } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } }"#;

/// Masks in a row.
fn chain(count: usize) -> String {
    let mut nodes = r#""n0": { "kind": "noise/simplex" }"#.to_owned();
    for node in 1..count {
        let before = node - 1;
        let _ = write!(
            nodes,
            r#", "n{node}": {{ "kind": "adjust/levels", "inputs": {{ "source": "n{before}" }} }}"#
        );
    }
    let last = count - 1;
    nodes + &format!(r#", "out": {{ "kind": "output/mask", "inputs": {{ "source": "n{last}" }} }}"#)
}

fn rays(count: usize) -> String {
    format!(
        r#""rays": {{ "kind": "surface/occlusion", "params": {{ "distance": 0.1, "rays": {count} }} }},
        "out": {{ "kind": "output/mask", "inputs": {{ "source": "rays" }} }}"#
    )
}

/// Returns the seconds of a bake, and its peak memory in MiB; `None` for the memory if the system has no file that reports it.
fn measured(folder: &Path, model: &Path, size: u32, nodes: &str) -> [f64; 2] {
    let graph = graph(folder, "scale.sabi", nodes);
    let request = request(folder, &graph, ModelOptions::new(model, size), adapter());
    // Writing 5 resets the peak to the memory in use now.
    let is_reset = fs::write("/proc/self/clear_refs", "5").is_ok();
    let started = Instant::now();
    bake(&request, &NoProgress).unwrap();
    let seconds = started.elapsed().as_secs_f64();
    [seconds, peak_mib().filter(|_| is_reset).unwrap_or(f64::NAN)]
}

fn peak_mib() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib / 1024.0)
}

/// Rows for growing counts, with the slopes from each to the next.
fn table(what: &str, counts: &[usize], run: impl Fn(usize) -> [f64; 2]) {
    let chosen = std::env::var("SABI_SCALE").ok();
    if chosen.is_some_and(|chosen| !chosen.split(',').any(|name| name == what)) {
        return;
    }
    println!("\n| {what} | time | slope | peak memory | slope |\n|---|---|---|---|---|");
    let mut before: Option<(usize, [f64; 2])> = None;
    for &count in counts {
        let now = run(count);
        let slope = |at: usize| match before {
            Some((few, then)) => format!("{:.2}", (now[at] / then[at]).ln() / (count as f64 / few as f64).ln()),
            None => String::new(),
        };
        println!(
            "| {count} | {:.2} s | {} | {:.0} MiB | {} |",
            now[0],
            slope(0),
            now[1],
            slope(1)
        );
        before = Some((count, now));
    }
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = |counts: Counts| -> PathBuf { models::write(folder, counts) };
    table(
        "texels",
        &[512, 1024, 2048, 4096, 8192].map(|side: usize| side * side),
        |texels| measured(folder, &model(PLAIN), texels.isqrt() as u32, FILTERED),
    );
    table("triangles", &[10_000, 100_000, 1_000_000, 10_000_000], |triangles| {
        measured(folder, &model(Counts { triangles, ..PLAIN }), 1024, FILTERED)
    });
    table("charts", &[1, 9, 100, 961, 10_000], |charts| {
        let triangles = 80_000;
        measured(
            folder,
            &model(Counts {
                triangles,
                charts,
                ..PLAIN
            }),
            2048,
            FILTERED,
        )
    });
    table("materials", &[1, 10, 50, 200], |materials| {
        let charts = 225;
        measured(
            folder,
            &model(Counts {
                materials,
                charts,
                ..PLAIN
            }),
            512,
            FILTERED,
        )
    });
    table("nodes", &[10, 100, 1000, 4000], |nodes| {
        measured(folder, &model(PLAIN), 512, &chain(nodes))
    });
    table("rays", &[4, 16, 64, 256], |count| {
        measured(folder, &model(PLAIN), 512, &rays(count))
    });
}
