//! Pictures of the model while it is turned by the pointer.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, Modifiers, PointerButton, vec2};
use sabi_gpu::AdapterChoice;

use crate::table::{ms, rate, row};
use crate::{busy_model, opened};

/// Turns a model with the graph of the slider, as a hand does, each picture painted on a screen.
pub(crate) fn orbit(adapter: &AdapterChoice, folder: &Path) {
    let graph = folder.join("orbit.sabi");
    std::fs::write(&graph, crate::slider::SLIDER).unwrap();
    let mut window = opened(adapter, &graph.display().to_string(), busy_model());
    window.rest();
    let middle = window.viewport().unwrap().center();
    let press = Event::PointerButton {
        pos: middle,
        button: PointerButton::Primary,
        pressed: true,
        modifiers: Modifiers::ALT,
    };
    window.paint(vec![Event::PointerMoved(middle), press]).unwrap();
    let (before, began) = (window.drawn().0, Instant::now());
    let mut frames = Vec::new();
    while began.elapsed() < Duration::from_secs(4) {
        let turned = 60.0 * (began.elapsed().as_secs_f32() * 2.0).sin();
        let frame = Instant::now();
        window
            .paint(vec![Event::PointerMoved(middle + vec2(turned, 0.3 * turned))])
            .unwrap();
        frames.push(ms(frame.elapsed()));
    }
    let drawn = (window.drawn().0 - before) as usize;
    rate("a model of 30 000 triangles is turned: pictures", drawn, began, "≥ 20");
    row("… of which one takes", frames, "≤ 50 ms");
}
