//! Time from a move of a slider to its pictures, and the rate of moves while something else is evaluated.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, PointerButton, vec2};
use sabi_editor::Offscreen;
use sabi_gpu::AdapterChoice;

use crate::frames::graph;
use crate::table::{ms, rate, row};
use crate::{busy_model, opened};

const MOVES: usize = 25;

/// Milliseconds from a move of a knob until the first picture of it, and until the full one, was drawn.
fn slide(window: &mut Offscreen, node: &str, value: f64, full: u32) -> [Option<f64>; 2] {
    let mut shown = [None, None];
    let mut before = window.drawn().0;
    let moved = Instant::now();
    window.turn(node, "at", value, true);
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

pub(crate) fn held(window: &Offscreen) -> Vec<Event> {
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
pub(crate) const SLIDER: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 512 }, "nodes": {
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "cut": { "kind": "adjust/threshold", "inputs": { "source": "clouds" }, "params": { "at": 0.5 }, "pos": [240, 0] },
    "levels": { "kind": "adjust/levels", "inputs": { "source": "cut" }, "pos": [480, 0] },
    "turned": { "kind": "adjust/invert", "inputs": { "source": "levels" }, "pos": [720, 0] },
    "both": { "kind": "blend/mask", "inputs": { "below": "turned", "above": "clouds" }, "pos": [960, 0] },
    "base": { "kind": "source/material", "pos": [960, 240] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "both", "height_map": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.01 }, "pos": [1200, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [1440, 0] } } }"##;

pub(crate) fn slider(adapter: &AdapterChoice, folder: &Path) {
    let graph = folder.join("slider.sabi");
    std::fs::write(&graph, SLIDER).unwrap();
    let mut window = opened(adapter, &graph.display().to_string(), busy_model());
    window.rest();
    let moves: Vec<[Option<f64>; 2]> = (0..MOVES)
        .map(|at| slide(&mut window, "cut", 0.3 + 0.01 * at as f64, 512))
        .collect();
    let first = moves.iter().filter_map(|[coarse, full]| coarse.or(*full)).collect();
    row("a slider moves: something is drawn", first, "≤ 60 ms");
    let full = moves.iter().filter_map(|[_, full]| *full).collect();
    row("a slider moves: the full picture is drawn", full, "≤ 150 ms");
}

/// Moves of a slider for some seconds, each painted on a screen, while 30 nodes at 1024² and their thumbnails are evaluated.
pub(crate) fn busy(adapter: &AdapterChoice, folder: &Path) {
    let mut window = opened(adapter, &graph(folder, 30, 1024), busy_model());
    window.rest();
    let moves: Vec<[Option<f64>; 2]> = (0..5)
        .map(|at| slide(&mut window, "cut_0", 0.3 + 0.01 * f64::from(at), 1024))
        .collect();
    let first = moves.iter().filter_map(|[coarse, full]| coarse.or(*full)).collect();
    row(
        "30 nodes at 1024²: a slider moves: something is drawn",
        first,
        "≤ 200 ms",
    );
    let full = moves.iter().filter_map(|[_, full]| *full).collect();
    row("… the full picture is drawn", full, "");
    window.rest();
    let (mut frames, mut answers) = (Vec::new(), Vec::new());
    let began = Instant::now();
    let mut drawn = window.drawn().0;
    let mut events = held(&window);
    while began.elapsed() < Duration::from_secs(5) {
        window.turn("cut_0", "at", 0.3 + 0.05 * began.elapsed().as_secs_f64(), true);
        let frame = Instant::now();
        window.paint(std::mem::take(&mut events)).unwrap();
        frames.push(ms(frame.elapsed()));
        if window.drawn().0 > drawn {
            drawn = window.drawn().0;
            answers.push(ms(began.elapsed()));
        }
    }
    rate(
        "a slider moves while 30 nodes at 1024² are evaluated: frames",
        frames.len(),
        began,
        "≥ 30",
    );
    row("… of which one takes", frames, "≤ 33 ms");
    rate("… new pictures of the model", answers.len(), began, "");
    window.turn("cut_0", "at", 0.5, false);
    let released = Instant::now();
    window.frame(Vec::new());
    while window.drawn().1 < 1024 && released.elapsed() < Duration::from_secs(60) {
        window.frame(Vec::new());
        window.wait(Duration::from_millis(50));
    }
    window.finish().unwrap();
    row("… the fine picture after the release", vec![ms(released.elapsed())], "");
}
