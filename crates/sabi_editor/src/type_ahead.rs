//! Keys that are pressed in the same frame as one that opens or closes a text field. They are meant for the widget that
//! has the keyboard focus afterwards, which egui knows only in a later frame.

use egui::{Context, Event, Id, Key, Modifiers, Response};

/// Most frames that keys wait for a text field to open or to close, in case that the key before them did neither.
const MOST_FRAMES: u32 = 3;

/// Keyboard events that wait for a later frame.
#[derive(Default)]
pub(crate) struct TypeAhead {
    held: Vec<Event>,
    awaited: Option<FocusChange>,
}

/// Change of the keyboard focus that held events wait for.
struct FocusChange {
    /// True if a text field opens, false if it closes.
    opens: bool,
    /// Frames for which they still wait.
    frames: u32,
}

impl TypeAhead {
    /// Gives this frame its keyboard events: those that were held back, then new ones, up to and including the first key that
    /// opens or closes a text field. Later ones are held back.
    pub(crate) fn split(&mut self, context: &Context, opens_text_field: impl Fn(Key, Modifiers) -> bool) {
        let is_typing = context.text_edit_focused();
        self.awaited = self.awaited.take().and_then(|FocusChange { opens, frames }| {
            let frames = frames.checked_sub(1).filter(|_| opens != is_typing)?;
            Some(FocusChange { opens, frames })
        });
        let is_waiting = self.awaited.is_some();
        let is_multiline = is_typing && is_in_multiline(context);
        let ends_frame = |key: Key, modifiers: Modifiers| {
            if is_typing {
                key == Key::Escape || matches!(key, Key::Enter | Key::Tab) && !is_multiline
            } else {
                opens_text_field(key, modifiers)
            }
        };
        // A quirk of egui: it takes the focus away on an Escape in the raw input at the start of a frame, and so does
        // not see an Escape that was held back here.
        let escape = |event: &Event| is_press(event, |key, modifiers| key == Key::Escape && modifiers.is_none());
        if is_typing && !is_waiting && self.held.iter().any(escape) {
            context.memory_mut(|memory| {
                if let Some(id) = memory.focused() {
                    memory.surrender_focus(id);
                }
            });
        }
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
                self.awaited = Some(FocusChange {
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

/// Key under which the text field with several lines that has the keyboard focus is remembered.
const MULTILINE: &str = "text field of several lines";

/// Remembers that a text field has several lines, in which Enter and Tab close nothing.
pub(crate) fn mark_multiline(field: &Response) {
    if field.has_focus() {
        field
            .ctx
            .data_mut(|data| data.insert_temp(Id::new(MULTILINE), field.id));
    }
}

fn is_in_multiline(context: &Context) -> bool {
    let marked: Option<Id> = context.data(|data| data.get_temp(Id::new(MULTILINE)));
    marked.is_some() && marked == context.memory(|memory| memory.focused())
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
