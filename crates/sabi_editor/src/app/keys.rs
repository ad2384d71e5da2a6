//! Keys: they act on what the pointer is over, or on the panel that was chosen by a key.

use std::time::{Duration, Instant};

use egui::{Context, Event, EventFilter, Id, Key, Modifiers, Popup, Ui};

use super::Editor;
use crate::action::Action;
use crate::canvas::{Way, focus_id};
use crate::command::{Command, GraphCommand, Scope};
use crate::dock::Panel;
use crate::key_map::Chord;

/// What the system holds comes within this time after it was asked for.
const PASTE_WITHIN: Duration = Duration::from_secs(2);

/// What keys that come next hang on.
#[derive(Default)]
pub(super) struct KeyState {
    /// When the system was asked for what it holds.
    asked_paste: Option<Instant>,
    /// Whether a text was being typed at the end of the last frame.
    pub(super) was_typing: bool,
}

impl Editor {
    /// What keys mean that were pressed since the last frame.
    pub(super) fn keys_pressed(&mut self, ui: &mut Ui) -> Vec<Action> {
        self.follow_pointer(ui);
        let context = ui.ctx().clone();
        let is_canvas_shown = self.rects.contains_key(&Panel::Canvas);
        if is_canvas_shown && self.canvas.holds_keys() || self.question().is_some() || self.files.is_start {
            return Vec::new();
        }
        if context.text_edit_focused() {
            return self.keys_beside_text(ui);
        }
        let is_spent = self.is_escape_spent(&context);
        self.hold_focus(&context);
        // What is dragged is in the middle of a step, which has to end first.
        if self.waits_for_key.is_some() || self.canvas.is_moving_nodes() || self.is_moving {
            return Vec::new();
        }
        let mut actions = Vec::new();
        let events = ui.input(|input| input.events.clone());
        for event in events {
            match event {
                Event::Key { key: Key::Escape, .. } if is_spent => {}
                Event::Key {
                    key,
                    pressed: true,
                    modifiers,
                    ..
                } => self.key(key, modifiers, ui, &mut actions),
                Event::Paste(text) if self.pastes_here() => {
                    let place = self.canvas.place_for_new(ui);
                    actions.push(Action::Paste { text, place });
                }
                event => {
                    if let Some(chord) = told_by_system(&event) {
                        self.key(chord.key, chord.modifiers, ui, &mut actions);
                    }
                }
            }
        }
        actions
    }

    /// Whether Escape has done something already: it ended a text or what was dragged out of a panel, or closes a menu.
    fn is_escape_spent(&self, context: &Context) -> bool {
        let is_dropped = context.drag_stopped_id().is_some() && !self.canvas.has_something_in_hand();
        self.key_state.was_typing || is_dropped || Popup::is_any_open(context)
    }

    /// While a text is typed, keys of the window that mean nothing to a text are still its own.
    fn keys_beside_text(&mut self, ui: &Ui) -> Vec<Action> {
        let pressed = |event: &Event| match event {
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } if modifiers.command || modifiers.alt || key.name().starts_with('F') && key.name().len() > 1 => {
                self.keys.command(Scope::Window, *modifiers, *key)
            }
            _ => None,
        };
        let commands: Vec<Command> = ui.input(|input| input.events.iter().filter_map(pressed).collect());
        let own = commands.into_iter().filter(|command| command.is_beside_text());
        own.map(Action::Do).collect()
    }

    /// Whether what the system holds goes into the graph: it was asked for, or comes by the key that usually does that.
    fn pastes_here(&mut self) -> bool {
        let asked = self
            .key_state
            .asked_paste
            .take()
            .is_some_and(|at| at.elapsed() < PASTE_WITHIN);
        let usual = self.keys.command(Scope::Canvas, Modifiers::COMMAND, Key::V);
        asked || self.active == Panel::Canvas && usual == Some(Command::Graph(GraphCommand::Paste))
    }

    /// Asks the system for what it holds, which comes as an event and only if it holds a text.
    pub(super) fn ask_paste(&mut self, context: &Context) {
        self.key_state.asked_paste = Some(Instant::now());
        context.send_viewport_cmd(egui::ViewportCommand::RequestPaste);
    }

    fn key(&mut self, key: Key, modifiers: Modifiers, ui: &Ui, actions: &mut Vec<Action>) {
        // A widget that was reached by keys keeps those that turn it.
        let is_ours = ui
            .ctx()
            .memory(|memory| memory.focused())
            .is_none_or(|id| id == focus_id() || id == anchor_id(self.active));
        let scope = match self.active {
            Panel::Canvas => Scope::Canvas,
            Panel::Viewport => Scope::Viewport,
            Panel::Flat => Scope::Flat,
            _ => Scope::Window,
        };
        if let Some(command) = self.keys.command(scope, modifiers, key)
            && (is_ours || command.scope() == Scope::Window)
        {
            actions.push(Action::Do(command));
            return;
        }
        if self.active != Panel::Canvas || modifiers.any() || !is_ours {
            return;
        }
        let way = match key {
            Key::ArrowLeft => Way::Left,
            Key::ArrowRight => Way::Right,
            Key::ArrowUp => Way::Up,
            Key::ArrowDown => Way::Down,
            _ => return,
        };
        actions.push(Action::Arrow(way));
    }

    /// The panel under the pointer is the one that keys are for, as soon as the pointer moves.
    fn follow_pointer(&mut self, ui: &Ui) {
        let (at, has_moved) = ui.input(|input| {
            let is_event = |event: &Event| matches!(event, Event::PointerMoved(_) | Event::PointerButton { .. });
            (input.pointer.hover_pos(), input.events.iter().any(is_event))
        });
        if let Some(at) = at.filter(|_| has_moved)
            && let Some((panel, _)) = self.rects.iter().find(|(_, rect)| rect.contains(at))
            && self.active != *panel
        {
            self.active = *panel;
            // What was turned by keys in another panel lets go of them; a text that is being typed does not.
            if !ui.ctx().text_edit_focused() {
                let_go_of_focus(ui.ctx());
            }
        }
    }

    /// While keys are for the canvas, Tab and the arrows are its own and do not lead from widget to widget.
    fn hold_focus(&self, context: &Context) {
        let id = focus_id();
        // A focus on what is not drawn leads programs astray that read the window to those who do not see it.
        let is_canvas = self.active == Panel::Canvas && self.rects.contains_key(&Panel::Canvas);
        context.memory_mut(|memory| {
            let focused = memory.focused();
            if is_canvas && focused.is_none() {
                memory.request_focus(id);
            }
            if is_canvas && memory.has_focus(id) {
                let filter = EventFilter {
                    tab: true,
                    horizontal_arrows: true,
                    vertical_arrows: true,
                    escape: true,
                };
                memory.set_focus_lock_filter(id, filter);
            } else if !is_canvas && memory.has_focus(id) {
                memory.surrender_focus(id);
            }
        });
    }

    /// Keys are for a panel that is shown.
    pub(super) fn leave_hidden(&mut self) {
        if !self.rects.contains_key(&self.active)
            && let Some(shown) = Panel::ALL.into_iter().find(|panel| self.rects.contains_key(panel))
        {
            self.active = shown;
        }
        if !self.rects.contains_key(&Panel::Canvas) {
            // What is in hand and asked there is not seen any more.
            self.canvas.drop_all();
        }
    }

    /// The next panel is the one that keys are for.
    pub(super) fn step_panel(&mut self, is_on: bool, context: &Context) {
        let shown: Vec<Panel> = Panel::ALL
            .into_iter()
            .filter(|panel| self.rects.contains_key(panel))
            .collect();
        let now = shown.iter().position(|panel| *panel == self.active).unwrap_or(0);
        let count = shown.len().max(1);
        let next = if is_on { now + 1 } else { now + count - 1 } % count;
        if let Some(panel) = shown.get(next) {
            self.active = *panel;
            let_go_of_focus(context);
            if *panel != Panel::Canvas {
                context.memory_mut(|memory| memory.request_focus(anchor_id(*panel)));
            }
            self.say(format!("Keys are for: {}", panel.title()));
        }
    }

    /// Files that were dropped on the window.
    pub(super) fn take_dropped(&mut self, context: &Context, actions: &mut Vec<Action>) {
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        for path in dropped.into_iter().filter_map(|file| file.path) {
            actions.push(Action::Dropped(path));
        }
    }
}

/// The key that the system tells of as what it usually means, whatever that is here. Whether more is held down with it nobody
/// tells.
pub(crate) fn told_by_system(event: &Event) -> Option<Chord> {
    let key = match event {
        Event::Copy => Key::C,
        Event::Cut => Key::X,
        Event::Paste(_) => Key::V,
        _ => return None,
    };
    Some(Chord {
        modifiers: Modifiers::COMMAND,
        key,
    })
}

/// What has the focus once a panel was chosen by a key: Tab leads from there to the first widget in it.
pub(super) fn anchor_id(panel: Panel) -> Id {
    Id::new(("keys are for", panel))
}

fn let_go_of_focus(context: &Context) {
    context.memory_mut(|memory| {
        if let Some(id) = memory.focused() {
            memory.surrender_focus(id);
        }
    });
}
