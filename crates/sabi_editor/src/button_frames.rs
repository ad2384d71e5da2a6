//! A frame for each button of the pointer.
//!
//! egui gives a press to what lies under the latest place of the pointer in a frame. While frames are slow, a quick drag
//! presses and moves within one of them, so that what lies under its end would be dragged, and a release followed by
//! movements would drop too late. What follows a button therefore waits for the next frame.

use std::collections::VecDeque;

use egui::{Context, Event, RawInput};

/// Events that wait for the next frame.
#[derive(Debug, Default)]
pub(crate) struct ButtonFrames {
    waiting: VecDeque<Event>,
}

impl ButtonFrames {
    /// Adds the events that wait before those of a frame, and leaves in it those up to its first button.
    pub(crate) fn enter_frame(&mut self, raw: &mut RawInput) {
        self.waiting.extend(raw.events.drain(..));
        let is_button = |event: &Event| matches!(event, Event::PointerButton { .. });
        let count = self
            .waiting
            .iter()
            .position(is_button)
            .map_or(self.waiting.len(), |at| at + 1);
        raw.events.extend(self.waiting.drain(..count));
    }

    /// Requests the next frame at once, if events wait for it.
    pub(crate) fn end_frame(&self, context: &Context) {
        if !self.waiting.is_empty() {
            context.request_repaint();
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::{Event, Modifiers, PointerButton, RawInput, pos2};

    use super::ButtonFrames;

    fn moved(x: f32) -> Event {
        Event::PointerMoved(pos2(x, 0.0))
    }

    fn button(x: f32, pressed: bool) -> Event {
        Event::PointerButton {
            pos: pos2(x, 0.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    #[test]
    fn a_drag_within_one_frame_is_a_press_then_a_way_with_a_release_then_what_follows() {
        let mut frames = ButtonFrames::default();
        let mut frame = |events: &[Event]| {
            let mut raw = RawInput {
                events: events.to_vec(),
                ..RawInput::default()
            };
            frames.enter_frame(&mut raw);
            raw.events
        };
        let drag = [
            moved(1.0),
            button(1.0, true),
            moved(2.0),
            moved(9.0),
            button(9.0, false),
            moved(20.0),
        ];
        assert_eq!(frame(&drag), drag[..2]);
        let typed = Event::Text("a".to_owned());
        assert_eq!(frame(std::slice::from_ref(&typed)), drag[2..5]);
        assert_eq!(frame(&[]), [moved(20.0), typed], "in their order");
        assert_eq!(frame(&[]), []);
    }
}
