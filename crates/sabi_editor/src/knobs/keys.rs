//! Keys of widgets that have the keyboard.

use egui::{EventFilter, InputState, Key, Modifiers, Response, Ui};

/// Factor of steps while Shift is held.
pub(super) const FINE: f64 = 0.1;

/// Keeps the arrow keys from leading to another widget.
pub(super) fn lock_arrow_keys(ui: &Ui, response: &Response) {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
}

/// Number of presses of a key; with Shift each counts a tenth.
pub(super) fn steps(input: &mut InputState, key: Key) -> f64 {
    let fine = input.count_and_consume_key(Modifiers::SHIFT, key) as f64;
    fine * FINE + input.count_and_consume_key(Modifiers::NONE, key) as f64
}

/// Steps to the right and down by the arrow keys.
pub(super) fn arrows(ui: &Ui, response: &Response) -> [f64; 2] {
    if !response.has_focus() {
        return [0.0, 0.0];
    }
    lock_arrow_keys(ui, response);
    ui.input_mut(|input| {
        let right = steps(input, Key::ArrowRight) - steps(input, Key::ArrowLeft);
        let down = steps(input, Key::ArrowDown) - steps(input, Key::ArrowUp);
        [right, down]
    })
}
