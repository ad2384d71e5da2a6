//! Time from a move of the brush to its pictures.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use sabi_editor::Offscreen;
use sabi_gpu::AdapterChoice;

use crate::table::{ms, row};
use crate::{busy_model, opened};

/// Strokes, and moves of each.
const STROKES: usize = 4;
const MOVES: usize = 20;

/// A painted mask with a height in a layer of rust, and a noise beside it.
const PAINTED: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 1024 }, "nodes": {
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "brush": { "kind": "source/paint", "pos": [0, 240] },
    "both": { "kind": "blend/mask", "inputs": { "below": "clouds", "above": "brush" }, "pos": [240, 0] },
    "base": { "kind": "source/material", "pos": [240, 240] },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "both", "height_map": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.01 }, "pos": [480, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "rust" }, "pos": [720, 0] } } }"##;

/// Milliseconds from events until the first picture that was drawn after them, and until the full one.
fn shown(window: &mut Offscreen, events: Vec<Event>) -> [Option<f64>; 2] {
    let mut shown = [None, None];
    let mut before = window.drawn().0;
    let moved = Instant::now();
    let mut events = Some(events);
    while shown[1].is_none() && moved.elapsed() < Duration::from_secs(20) {
        window.frame(events.take().unwrap_or_default()); // Later frames have none.
        let (drawn, size) = window.drawn();
        if drawn > before {
            before = drawn;
            window.finish().unwrap();
            shown[usize::from(size >= 1024)] = Some(ms(moved.elapsed()));
        } else {
            window.wait(Duration::from_millis(50));
        }
    }
    shown
}

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// Strokes with a brush of 4 % of the model at 1024².
pub(crate) fn painting(adapter: &AdapterChoice, folder: &Path) {
    let graph = folder.join("painted.sabi");
    std::fs::write(&graph, PAINTED).unwrap();
    let mut window = opened(adapter, &graph.display().to_string(), busy_model());
    window.rest();
    window.paint_on("brush");
    window.rest();
    let middle = window.viewport().unwrap().center();
    let (mut first, mut full) = (Vec::new(), Vec::new());
    for stroke in 0..STROKES {
        let start = middle + vec2(-40.0, 20.0 * stroke as f32 - 30.0);
        window.frame(vec![Event::PointerMoved(start)]);
        window.frame(vec![button(start, true)]);
        for at in 1..=MOVES {
            // A picture of the move before must not be taken for one of this.
            window.rest();
            let [coarse, fine] = shown(
                &mut window,
                vec![Event::PointerMoved(start + vec2(6.0 * at as f32, 0.0))],
            );
            first.extend(coarse.or(fine));
            full.extend(fine);
        }
        window.frame(vec![button(start + vec2(6.0 * MOVES as f32, 0.0), false)]);
        window.rest();
    }
    row("the brush moves: something is drawn", first, "≤ 30 ms");
    row("the brush moves: the full picture is drawn", full, "");
}
