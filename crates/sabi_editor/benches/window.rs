//! `cargo bench --bench window`: what frames of the window take of the processor, how soon it shows something, and how soon it
//! shows what a slider does. Medians and the worst of some frames; nothing here asserts. `-- slider`, `-- frames`, `-- clicks`
//! and `-- start` measure that alone.

#![allow(clippy::print_stdout, reason = "a bench's table is its output")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot run may stop")]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Event, MouseWheelUnit, PointerButton, Pos2, TouchPhase, vec2};
use sabi_editor::{FrameTime, Offscreen};
use sabi_engine::AdapterChoice;

const FRAMES: usize = 60;
const MOVES: usize = 25;
const SIZE: [f32; 2] = [1600.0, 900.0];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn opened(adapter: &AdapterChoice, graph: &str, model: PathBuf) -> Offscreen {
    let render = egui_kittest::wgpu::create_render_state(Offscreen::setup(adapter), Default::default());
    Offscreen::open(graph, model, render, SIZE).unwrap()
}

/// So many nodes, in rows of clouds, filters of points and layers, as artists stack them.
fn graph(folder: &Path, count: usize, size: u32) -> String {
    let mut nodes = String::new();
    let rows = count / 10;
    for row in 0..rows {
        let below = match row {
            0 => "base".to_owned(),
            _ => format!("layer_{}", row - 1),
        };
        let y = 240 * row;
        let _ = write!(
            nodes,
            r##""clouds_{row}": {{ "kind": "noise/simplex", "params": {{ "octaves": 3, "seed": {row} }}, "pos": [0, {y}] }},
            "cells_{row}": {{ "kind": "noise/cells", "params": {{ "seed": {row} }}, "pos": [0, {}] }},
            "cut_{row}": {{ "kind": "adjust/threshold", "inputs": {{ "source": "clouds_{row}" }}, "params": {{ "at": 0.5 }},
              "pos": [240, {y}] }},
            "levels_{row}": {{ "kind": "adjust/levels", "inputs": {{ "source": "cells_{row}" }}, "pos": [240, {}] }},
            "both_{row}": {{ "kind": "blend/mask", "inputs": {{ "below": "cut_{row}", "above": "levels_{row}" }},
              "pos": [480, {y}] }},
            "turned_{row}": {{ "kind": "adjust/invert", "inputs": {{ "source": "both_{row}" }}, "pos": [720, {y}] }},
            "clamped_{row}": {{ "kind": "adjust/clamp", "inputs": {{ "source": "turned_{row}" }}, "pos": [960, {y}] }},
            "shaped_{row}": {{ "kind": "adjust/remap", "inputs": {{ "source": "clamped_{row}" }}, "pos": [1200, {y}] }},
            "up_{row}": {{ "kind": "surface/direction", "pos": [1200, {}] }},
            "layer_{row}": {{ "kind": "effect/layer", "inputs": {{ "base": "{below}", "mask": "shaped_{row}" }},
              "params": {{ "color": "#6b3a1e", "opacity": 0.3 }}, "pos": [1440, {y}] }},
            "##,
            y + 120,
            y + 120,
            y + 120
        );
    }
    let text = format!(
        r##"{{ "format": "sabi", "version": 1, "name": "bench", "preview": {{ "size": {size} }}, "nodes": {{ {nodes}
            "base": {{ "kind": "source/material", "pos": [1200, -240] }},
            "out": {{ "kind": "output/material", "inputs": {{ "material": "layer_{}" }}, "pos": [1680, 0] }} }} }}"##,
        rows - 1
    );
    let path = folder.join(format!("graph{count}.sabi"));
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// The middle one and the last of some times, milliseconds.
fn spread(mut times: Vec<f64>) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    [times.len() / 2, times.len() - 1].map(|at| times.get(at).copied().unwrap_or(f64::NAN))
}

fn row(what: &str, times: Vec<f64>, aim: &str) {
    let [middle, worst] = spread(times);
    println!("| {what} | {middle:.1} ms | {worst:.1} ms | {aim} |");
}

/// Frames in each of which something happens.
fn frames(window: &mut Offscreen, happens: impl Fn(usize, &mut Offscreen) -> Vec<Event>) -> Vec<FrameTime> {
    let frame = |at| {
        let events = happens(at, window);
        window.frame(events)
    };
    (0..FRAMES).map(frame).collect()
}

fn wheel(at: Pos2, by: egui::Vec2, modifiers: egui::Modifiers) -> Vec<Event> {
    let turned = Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: by,
        phase: TouchPhase::Move,
        modifiers,
    };
    vec![Event::PointerMoved(at), turned]
}

/// Measures and prints the frame times of several interactions with the open graph.
fn frames_of(window: &mut Offscreen, what: &str, aim: &str) {
    let middle = window.canvas().unwrap().center();
    let tell = |name: &str, times: Vec<FrameTime>| {
        let whole = times.iter().map(|time| ms(time.whole())).collect();
        row(&format!("{what}: {name}"), whole, aim);
    };
    let still = frames(window, |_, _| Vec::new());
    let cut = spread(still.iter().map(|time| ms(time.tessellation)).collect());
    let triangles = still.last().map_or(0, |time| time.triangles);
    tell("nothing happens", still);
    println!(
        "| … of which cutting {triangles} triangles | {:.1} ms | {:.1} ms | |",
        cut[0], cut[1]
    );
    let around = |at: usize| middle + vec2(3.0 * (at % 40) as f32, 2.0 * (at % 30) as f32);
    tell(
        "the pointer moves",
        frames(window, |at, _| vec![Event::PointerMoved(around(at))]),
    );
    let pan = |at: usize| {
        let step = if at.is_multiple_of(2) { 12.0 } else { -12.0 };
        wheel(middle, vec2(0.0, step), egui::Modifiers::SHIFT)
    };
    tell("the canvas is moved", frames(window, |at, _| pan(at)));
    let turn = |at: usize, window: &mut Offscreen| {
        window.turn("cut_0", "at", 0.3 + 0.005 * at as f64, true);
        Vec::new()
    };
    tell("a knob is turned", frames(window, turn));
    window.turn("cut_0", "at", 0.5, false);
    window.rest();
    let painted = (0..FRAMES).map(|at| ms(window.paint(vec![Event::PointerMoved(around(at))]).unwrap()));
    row(
        &format!("{what}: painted on a screen, too"),
        painted.collect(),
        "≤ 50 ms",
    );
}

/// Milliseconds from a move of a knob until the first picture of it, and until the full one, was drawn.
fn slide(window: &mut Offscreen, value: f64) -> [Option<f64>; 2] {
    let mut shown = [None, None];
    let (mut before, full) = (window.drawn().0, 512);
    let moved = Instant::now();
    window.turn("cut", "at", value, true);
    // The pointer is held down all the while.
    let mut began = false;
    while shown[1].is_none() && moved.elapsed() < Duration::from_secs(20) {
        let events = if began { Vec::new() } else { held(window) };
        began = true;
        window.frame(events);
        let (drawn, size) = window.drawn();
        if drawn > before {
            before = drawn;
            window.finish().unwrap();
            shown[usize::from(size >= full)] = Some(ms(moved.elapsed()));
        } else {
            window.wait(Duration::from_millis(50));
        }
    }
    shown
}

fn held(window: &Offscreen) -> Vec<Event> {
    let at = window.canvas().unwrap().right_bottom() - vec2(9.0, 9.0);
    let press = Event::PointerButton {
        pos: at,
        button: PointerButton::Extra1,
        pressed: true,
        modifiers: egui::Modifiers::NONE,
    };
    vec![Event::PointerMoved(at), press]
}

/// Five point nodes in a row, the first of which has the slider.
const SLIDER: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 512 }, "nodes": {
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "cut": { "kind": "adjust/threshold", "inputs": { "source": "clouds" }, "params": { "at": 0.5 }, "pos": [240, 0] },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "cut" }, "pos": [480, 0] },
    "turned": { "kind": "adjust/invert", "inputs": { "source": "levels" }, "pos": [720, 0] },
    "both": { "kind": "blend/mask", "inputs": { "below": "turned", "above": "clouds" }, "pos": [960, 0] },
    "base": { "kind": "source/material", "pos": [960, 240] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "both", "height_map": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.01 }, "pos": [1200, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [1440, 0] } } }"##;

fn slider(adapter: &AdapterChoice, folder: &Path) {
    let shared = root().join("../shared/data/meshes/bench-suzanne30k/mesh30k.glb");
    let model = if shared.is_file() {
        shared
    } else {
        root().join("assets/meshes/figure.glb")
    };
    let graph = folder.join("slider.sabi");
    std::fs::write(&graph, SLIDER).unwrap();
    let mut window = opened(adapter, &graph.display().to_string(), model);
    window.rest();
    let moves: Vec<[Option<f64>; 2]> = (0..MOVES)
        .map(|at| slide(&mut window, 0.3 + 0.01 * at as f64))
        .collect();
    let first = moves.iter().filter_map(|[coarse, full]| coarse.or(*full)).collect();
    row("a slider moves: something is drawn", first, "≤ 60 ms");
    let full = moves.iter().filter_map(|[_, full]| *full).collect();
    row("a slider moves: the full picture is drawn", full, "≤ 150 ms");
}

/// Frames of the second in which a node of each type is shown for the first time: pictures of each are drawn by pipelines of their own.
fn clicks(adapter: &AdapterChoice, folder: &Path) {
    let graph = folder.join("types.sabi");
    std::fs::write(&graph, TYPES).unwrap();
    let mut window = opened(
        adapter,
        &graph.display().to_string(),
        root().join("assets/meshes/cube.glb"),
    );
    window.rest();
    for (node, what) in [
        ("clouds", "mask"),
        ("paint", "color"),
        ("normal", "vector"),
        ("base", "material"),
    ] {
        window.rest();
        window.look_at(node);
        let (clicked, mut frames) = (Instant::now(), Vec::new());
        while clicked.elapsed() < Duration::from_secs(1) {
            frames.push(ms(window.frame(Vec::new()).whole()));
            window.wait(Duration::from_millis(50));
        }
        row(&format!("frames in which a first {what} is shown"), frames, "≤ 50 ms");
    }
}

/// A node of each type.
const TYPES: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 256 }, "nodes": {
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "paint": { "kind": "color/constant", "pos": [240, 0] },
    "normal": { "kind": "surface/position", "pos": [480, 0] },
    "base": { "kind": "source/material", "pos": [720, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "base" }, "pos": [960, 0] } } }"##;

/// From nothing to a first picture of the graph that the program comes with.
fn start(adapter: &AdapterChoice) {
    let [graph, model] = ["graphs/weathered-bench.sabi", "assets/meshes/bench.glb"].map(|path| root().join(path));
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

fn main() {
    let adapter = match std::env::var("SABI_ADAPTER") {
        Ok(name) => name.parse().unwrap(),
        Err(_) => AdapterChoice::Auto,
    };
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_wanted = |part: &str| wanted.is_empty() || wanted.iter().any(|word| word == part);
    let folder = tempfile::tempdir().unwrap();
    println!("| what | the middle one | the worst | aim |\n|---|---|---|---|");
    if is_wanted("start") {
        start(&adapter);
    }
    if is_wanted("frames") {
        for (count, aim) in [(60, "≤ 8 ms"), (500, "≤ 16 ms")] {
            all_frames(&adapter, folder.path(), count, aim);
        }
    }
    if is_wanted("clicks") {
        clicks(&adapter, folder.path());
    }
    if is_wanted("slider") {
        slider(&adapter, folder.path());
    }
}

/// Frames of a graph that is seen whole, and of one that is not.
fn all_frames(adapter: &AdapterChoice, folder: &Path, count: usize, aim: &str) {
    let cube = root().join("assets/meshes/cube.glb");
    let mut window = opened(adapter, &graph(folder, count, 64), cube);
    window.rest();
    frames_of(&mut window, &format!("{count} nodes, all seen"), aim);
    let middle = window.canvas().unwrap().center();
    for _ in 0..24 {
        window.frame(wheel(middle, vec2(0.0, 60.0), egui::Modifiers::NONE));
    }
    window.rest();
    frames_of(&mut window, &format!("{count} nodes, some seen"), aim);
}
