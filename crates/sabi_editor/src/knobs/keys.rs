//! Keys that widgets take while they have the keyboard.

use egui::{EventFilter, InputState, Key, Modifiers, Response, Ui};

/// Shift is held for a tenth of each step.
pub(super) const FINE: f64 = 0.1;

/// Keeps the arrow keys from leading to another widget.
pub(super) fn hold_arrows(ui: &Ui, response: &Response) {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
}

/// How often a key was pressed; with Shift it counts a tenth.
pub(super) fn steps(input: &mut InputState, key: Key) -> f64 {
    let fine = input.count_and_consume_key(Modifiers::SHIFT, key) as f64;
    fine * FINE + input.count_and_consume_key(Modifiers::NONE, key) as f64
}

/// Steps to the right and down that the keyboard asks a widget for.
pub(super) fn arrows(ui: &Ui, response: &Response) -> [f64; 2] {
    if !response.has_focus() {
        return [0.0, 0.0];
    }
    hold_arrows(ui, response);
    ui.input_mut(|input| {
        let right = steps(input, Key::ArrowRight) - steps(input, Key::ArrowLeft);
        let down = steps(input, Key::ArrowDown) - steps(input, Key::ArrowUp);
        [right, down]
    })
}
