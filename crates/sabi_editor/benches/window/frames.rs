//! Times of frames on the processor, with and without input.

use std::fmt::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, MouseWheelUnit, Pos2, TouchPhase, vec2};
use sabi_editor::{FrameTime, Offscreen};
use sabi_gpu::AdapterChoice;

use crate::table::{ms, row, spread};
use crate::{asset, opened};

const FRAMES: usize = 60;

/// Graph of `count` nodes, in rows of clouds, filters of points and layers, as artists stack them.
pub(crate) fn graph(folder: &Path, count: usize, size: u32) -> String {
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

/// Times of frames, each with the events that `happens` gives.
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

/// Times of the frames in the second in which a node of each type is shown for the first time: pictures of each type
/// are drawn by pipelines of their own.
pub(crate) fn clicks(adapter: &AdapterChoice, folder: &Path) {
    let graph = folder.join("types.sabi");
    std::fs::write(&graph, TYPES).unwrap();
    let mut window = opened(adapter, &graph.display().to_string(), asset("assets/meshes/cube.glb"));
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

/// Frames of a graph that is seen whole, and of one that is not.
pub(crate) fn all_frames(adapter: &AdapterChoice, folder: &Path, count: usize, aim: &str) {
    let cube = asset("assets/meshes/cube.glb");
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
