//! Rays and filters on the surface, at 1024², on the 30 000-triangle model.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use sabi_engine::evaluating::EvaluatorOptions;
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use sabi_engine::{Evaluator, Kinds, OpenGraph};
use sabi_gpu::{CasterChoice, DEFAULT_BUDGET_BYTES, StepTime};
use sabi_graph::{Document, Fit, Overrides};
use sabi_plan::{Mode, Target};
use sabi_surface::bvh::Bvh;

use super::setup::adapter;
use super::{bake_once, graph, row};

const SIZE: u32 = 1024;
const DISTANCE: f64 = 0.05;

/// The best of three bakes: seconds that a node takes.
fn node_seconds(folder: &Path, model: &Path, name: &str, nodes: &str) -> f64 {
    let nodes = format!(r#"{nodes}, "out": {{ "kind": "output/mask", "inputs": {{ "source": "{name}" }} }}"#);
    let graph = graph(folder, "surface.sabi", &nodes);
    let once = || {
        bake_once(&graph, model, folder, SIZE, true, None)["nodes_ms"][name]
            .as_f64()
            .unwrap()
    };
    (0..3).map(|_| once()).fold(f64::INFINITY, f64::min) / 1000.0
}

/// Returns the seconds that the hierarchy alone takes for as many rays of the same kind, on all cores.
fn bare_seconds(linked: &LinkedModel, rays: u32) -> (f64, f64) {
    let bvh = Bvh::build(&linked.model.mesh);
    let fit = Fit::Unit;
    let tables = linked.fitted(fit).tables(0);
    let scale = linked.fitted(fit).working_from_model() as f32;
    let [width, _] = linked.atlas.page_size;
    let owned = linked
        .atlas
        .owners
        .iter()
        .enumerate()
        .filter(|(_, owner)| **owner >> 31 == 0);
    let shots: Vec<([f32; 3], [f32; 3])> = owned
        .flat_map(|(index, &triangle)| {
            let rows = &tables.geometry[6 * triangle as usize..][..6];
            let step = [index as u32 % width, index as u32 / width].map(|texel| texel as f32 + 0.5);
            let step = [step[0] - rows[0][3], step[1] - rows[1][3]];
            let at = |axis: usize| rows[0][axis] + rows[1][axis] * step[0] + rows[2][axis] * step[1];
            let normal = |axis: usize| rows[3][axis] + rows[4][axis] * step[0] + rows[5][axis] * step[1];
            let up = glam::Vec3::new(normal(0), normal(1), normal(2)).normalize_or(glam::Vec3::Y);
            let origin = glam::Vec3::new(at(0), at(1), at(2)) + up * 1e-5;
            (0..rays).map(move |ray| {
                // Points of a sphere that touches the surface give cosine-weighted directions.
                let turn = (index as u32 * 64 + ray).wrapping_mul(2_654_435_769) as f32 / 4_294_967_296.0;
                let height = ((ray as f32 + turn) / rays as f32) * 2.0 - 1.0;
                let round = (1.0 - height * height).max(0.0).sqrt();
                let (sine, cosine) = (turn * 97.0).sin_cos();
                let direction = (up + glam::Vec3::new(round * cosine, round * sine, height)).normalize_or(up);
                ((origin / scale).to_array(), direction.to_array())
            })
        })
        .collect();
    let reach = DISTANCE as f32 / scale;
    let best = (0..3)
        .map(|_| {
            let started = Instant::now();
            let hits = shots
                .par_iter()
                .with_min_len(1024)
                .filter(|(origin, direction)| bvh.any(*origin, *direction, reach))
                .count();
            std::hint::black_box(hits);
            started.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    (best, shots.len() as f64)
}

pub(crate) fn bench_rays(folder: &Path, model: &Path) {
    let linked = LinkedModel::open(&ModelOptions::new(model, SIZE), &NoProgress).unwrap();
    for (rays, aim) in [(16, "≤ 1.6 s"), (3, "≤ 0.4 s")] {
        let nodes = format!(
            r#""rays": {{ "kind": "surface/occlusion", "params": {{ "distance": {DISTANCE}, "rays": {rays} }} }}"#
        );
        let taken = node_seconds(folder, model, "rays", &nodes);
        let (bare, count) = bare_seconds(&linked, rays);
        row(&format!("occlusion, {rays} rays, at {SIZE}²"), taken, "s", aim);
        row("the same, rays a second", count / taken / 1e6, "M", "");
        row(
            "the same, as a multiple of the bare hierarchy",
            taken / bare,
            "×",
            "≤ 1.4 ×",
        );
    }
}

/// Prints a row with the share of a filter's time in which ghosts are filled (the best of three runs) and the numbers of
/// texels and ghosts. The program waits for both, so that they do not overlap.
fn ghost_row(what: &str, model: &Path, nodes: &str) {
    let text = format!(r#"{{ "format": "sabi", "version": 1, "nodes": {{ {nodes} }} }}"#);
    let open = OpenGraph::of_document("bench.sabi", Document::from_json(&text).unwrap());
    let options = EvaluatorOptions {
        model: ModelOptions::new(model, SIZE),
        overrides: Overrides::default(),
        fit: None,
        adapter: adapter(),
        caster: CasterChoice::Auto,
        budget_bytes: DEFAULT_BUDGET_BYTES,
    };
    let kinds = Kinds::builtin();
    let graph = options.flat_graph(&open, &kinds).unwrap();
    let node = graph.nodes.iter().position(|node| node.id == "filter").unwrap();
    let mut evaluator = Evaluator::open(&open, graph, kinds, &options, &NoProgress).unwrap();
    evaluator.time_ghosts();
    let target = Target { node, port: None };
    let plan = evaluator.plan(&[target], Mode::Bake { fuse: true }).unwrap();
    let mut once = || {
        let report = evaluator
            .run(&plan, Duration::from_millis(200), &NoProgress, None)
            .unwrap()
            .report;
        let of_filter = |step: &&StepTime| step.nodes.iter().any(|(id, _)| id == "filter");
        let all: Duration = report.steps.iter().filter(of_filter).map(|step| step.run).sum();
        report.ghosts.as_secs_f64() / all.as_secs_f64()
    };
    let share = (0..3).map(|_| once()).fold(f64::INFINITY, f64::min);
    let atlas = &evaluator.linked().atlas;
    let texels: u64 = atlas.charts.iter().map(|chart| u64::from(chart.texels)).sum();
    let what = format!("{what}, {} beside {texels} texels", atlas.ghosts.len());
    row(&what, 100.0 * share, "%", "≤ 8 %");
}

/// Writes a cube whose sides are charts with edges of 297 texels, which cover half of the sheet: few ghosts compared with owned texels.
fn cube(folder: &Path) -> PathBuf {
    const SIDES: [[usize; 4]; 6] = [
        [1, 3, 4, 2],
        [5, 6, 8, 7],
        [1, 2, 6, 5],
        [3, 7, 8, 4],
        [1, 5, 7, 3],
        [2, 4, 8, 6],
    ];
    let mut text = String::new();
    for corner in 0..8 {
        let _ = writeln!(text, "v {} {} {}", corner & 1, corner >> 1 & 1, corner >> 2);
    }
    for (side, corners) in SIDES.iter().enumerate() {
        let [left, low] = [side % 3, side / 3].map(|step| 0.02 + 0.33 * step as f64);
        let [right, high] = [left, low].map(|at| at + 0.29);
        let _ = writeln!(
            text,
            "vt {left} {low}\nvt {right} {low}\nvt {right} {high}\nvt {left} {high}"
        );
        let [a, b, c, d] = *corners;
        let first = 4 * side + 1;
        let [second, third, fourth] = [first + 1, first + 2, first + 3];
        let _ = writeln!(text, "f {a}/{first} {b}/{second} {c}/{third} {d}/{fourth}");
    }
    let path = folder.join("cube.obj");
    fs::write(&path, text).unwrap();
    path
}

fn on_noise(kind: &str, params: &str) -> String {
    format!(
        r#""noise": {{ "kind": "noise/simplex", "params": {{ "size": 0.05 }} }},
        "filter": {{ "kind": "filter/{kind}", "inputs": {{ "source": "noise" }}, "params": {{ {params} }} }}"#
    )
}

pub(crate) fn bench_ghosts(folder: &Path, model: &Path) {
    let nodes = on_noise("smooth", r#""steps": 64"#);
    ghost_row("share of ghosts in a pass over nine neighbors", model, &nodes);
    ghost_row("the same on a cube of six charts", &cube(folder), &nodes);
}

pub(crate) fn bench_filters(folder: &Path, model: &Path) {
    let taken = |kind: &str, params: &str| node_seconds(folder, model, "filter", &on_noise(kind, params));
    let blur = taken("blur", r#""radius": 0.05"#);
    row("filter/blur at 1024², radius 0.05", blur, "s", "≤ 0.25 s");
    let twice = taken("blur", r#""radius": 0.1"#) / blur;
    row("the same, radius doubled, as a multiple", twice, "×", "≤ 1.5 ×");
    // The difference between sixty-four repetitions and one removes the fixed cost of a run.
    let steps = |steps: u32| taken("smooth", &format!(r#""steps": {steps}"#));
    let pass = (steps(64) - steps(1)) / 63.0;
    row("a pass over nine neighbors, ghosts filled", 1000.0 * pass, "ms", "");
    row("the same, passes a second", 1.0 / pass, "", "");
    for (kind, params) in [
        ("distance", r#""width": 0.05"#),
        ("grow", r#""radius": 0.01"#),
        ("median", r#""radius": 0.005"#),
        ("sharpen", r#""radius": 0.01"#),
        ("streak", ""),
    ] {
        row(
            &format!("filter/{kind} at 1024², {params}"),
            taken(kind, params),
            "s",
            "",
        );
    }
}
