//! Keys that are pressed in the same frame as one that opens or closes a text field. They are meant for what has the keyboard
//! focus afterwards, which egui knows only in a later frame.

use egui::{Context, Event, Key, Modifiers};

/// Most frames that keys wait for a text field to open or to close, in case that the key before them did neither.
const MOST_FRAMES: u32 = 3;

/// Keyboard events that wait for a later frame.
#[derive(Default)]
pub(super) struct TypeAhead {
    held: Vec<Event>,
    awaited: Option<Awaited>,
}

/// Change of the keyboard focus that held events wait for.
struct Awaited {
    /// True if a text field opens, false if it closes.
    opens: bool,
    /// Frames for which they still wait.
    frames: u32,
}

impl TypeAhead {
    /// Gives this frame its keyboard events: those that were held back, then new ones, up to and including the first key that
    /// opens or closes a text field. Later ones are held back.
    pub(super) fn split(&mut self, context: &Context, opens_text_field: impl Fn(Key, Modifiers) -> bool) {
        let is_typing = context.text_edit_focused();
        self.awaited = self.awaited.take().and_then(|Awaited { opens, frames }| {
            let frames = frames.checked_sub(1).filter(|_| opens != is_typing)?;
            Some(Awaited { opens, frames })
        });
        let is_waiting = self.awaited.is_some();
        let ends_frame = |key: Key, modifiers: Modifiers| {
            if is_typing {
                matches!(key, Key::Enter | Key::Escape | Key::Tab)
            } else {
                opens_text_field(key, modifiers)
            }
        };
        context.input_mut(|input| {
            let is_ended = input.events.iter().any(|event| is_press(event, ends_frame));
            if self.held.is_empty() && !is_waiting && !is_ended {
                return;
            }
            let (typed, mut events) = std::mem::take(&mut input.events).into_iter().partition(is_keyboard);
            let mut queue = std::mem::take(&mut self.held);
            queue.extend::<Vec<Event>>(typed);
            if is_waiting {
                self.held = queue;
            } else if let Some(at) = queue.iter().position(|event| is_press(event, ends_frame)) {
                self.held = queue.split_off(at + 1);
                // The text of the key itself, such as the space of the space bar, is not typed into the field.
                if !is_typing && matches!(self.held.first(), Some(Event::Text(_))) {
                    self.held.remove(0);
                }
                self.awaited = Some(Awaited {
                    opens: !is_typing,
                    frames: MOST_FRAMES,
                });
                events.extend(queue);
            } else {
                events.extend(queue);
            }
            input.events = events;
        });
        if !self.held.is_empty() {
            context.request_repaint();
        }
    }
}

/// Returns whether an event is the press of a key for which a condition holds.
fn is_press(event: &Event, condition: impl Fn(Key, Modifiers) -> bool) -> bool {
    match event {
        Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } => condition(*key, *modifiers),
        _ => false,
    }
}

fn is_keyboard(event: &Event) -> bool {
    matches!(
        event,
        Event::Key { .. } | Event::Text(_) | Event::Ime(_) | Event::Copy | Event::Cut | Event::Paste(_)
    )
}
