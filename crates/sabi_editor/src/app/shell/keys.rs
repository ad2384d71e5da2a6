//! Keys: they act on the panel under the pointer, or on the one that was chosen by a key.

use std::time::{Duration, Instant};

use egui::{Context, Event, EventFilter, FocusDirection, Key, Memory, Modifiers, Popup, Response, Ui, ViewportCommand};
use sabi_editing::command::ClipboardCommand;
use sabi_paint::is_text_of_strokes;

use super::Shell;
use crate::action::{Action, ArrowKey, PaintAction};
use crate::canvas::focus_id;
use crate::command::{Command, GraphCommand, Scope};
use crate::dock::{Panel, anchor_id};
use crate::key_map::from_clipboard_event;
use crate::type_ahead::TypeAhead;
use crate::views::Views;

/// Time within which the clipboard's contents arrive after they were requested.
const PASTE_WITHIN: Duration = Duration::from_secs(2);

/// State that the effect of keys depends on.
pub(crate) struct Keyboard {
    /// Panel that keys act on.
    pub(crate) active: Panel,
    /// Time when the clipboard was requested.
    paste_requested: Option<Instant>,
    /// True if a text field had the keyboard focus at the end of the last frame.
    was_typing: bool,
    type_ahead: TypeAhead,
}

impl Default for Keyboard {
    fn default() -> Keyboard {
        Keyboard {
            active: Panel::Canvas,
            paste_requested: None,
            was_typing: false,
            type_ahead: TypeAhead::default(),
        }
    }
}

impl Keyboard {
    /// Requests the clipboard from the system. It arrives as an event if it contains a text.
    pub(crate) fn request_paste(&mut self, context: &Context) {
        self.paste_requested = Some(Instant::now());
        context.send_viewport_cmd(ViewportCommand::RequestPaste);
    }

    /// Remembers at the end of a frame whether a text field has the keyboard focus.
    pub(crate) fn end_frame(&mut self, context: &Context) {
        self.was_typing = context.text_edit_focused();
    }

    /// Scope of the keys that act on the active panel.
    fn scope(&self) -> Scope {
        match self.active {
            Panel::Canvas => Scope::Canvas,
            Panel::Viewport => Scope::Viewport,
            Panel::Flat => Scope::Flat,
            Panel::Parameters
            | Panel::Stack
            | Panel::Library
            | Panel::Export
            | Panel::History
            | Panel::Problems
            | Panel::Timing
            | Panel::Page => Scope::Window,
        }
    }
}

impl Shell {
    /// Actions of the keys that were pressed since the last frame.
    pub(crate) fn keys_pressed(&mut self, ui: &Ui, views: &Views, is_dragging: bool) -> Vec<Action> {
        self.follow_pointer(ui);
        let context = ui.ctx();
        self.take_tab_from_text(ui);
        let scope = self.keyboard.scope();
        let opens_text_field = |key, modifiers| {
            let command = self.keys.command(scope, modifiers, key);
            command.is_some_and(Command::may_open_text_field)
        };
        self.keyboard.type_ahead.split(context, opens_text_field);
        let canvas_holds_keys = self.dock.is_shown(Panel::Canvas) && views.canvas.holds_keys();
        if canvas_holds_keys || views.questions.open.is_some() || views.start.is_open {
            return Vec::new();
        }
        if context.text_edit_focused() {
            return self.keys_beside_text(ui);
        }
        let is_escape_spent = self.is_escape_spent(context, views);
        self.keep_focus(context);
        // The undo step of a drag is open, and has to end before a command runs.
        if views.key_list.takes_keys() || views.canvas.is_moving_nodes() || is_dragging {
            return Vec::new();
        }
        let mut actions = Vec::new();
        let events = ui.input(|input| input.events.clone());
        for event in events {
            match event {
                Event::Key { key: Key::Escape, .. } if is_escape_spent => {}
                Event::Key {
                    key,
                    pressed: true,
                    modifiers,
                    ..
                } => actions.extend(self.key(key, modifiers, context)),
                Event::Paste(text) if is_text_of_strokes(&text) => {
                    actions.push(Action::Paint(PaintAction::PasteStrokes(text)));
                }
                Event::Paste(text) if self.pastes_here() => {
                    let place = views.canvas.camera.place_for_new(ui);
                    actions.push(Action::edit(ClipboardCommand::Paste { text, place }));
                }
                event => {
                    let chord = from_clipboard_event(&event);
                    actions.extend(chord.and_then(|chord| self.key(chord.key, chord.modifiers, context)));
                }
            }
        }
        actions
    }

    /// Takes the keyboard focus from a text field of another panel when Tab runs a command of the active panel, such as
    /// adding a node. Otherwise Tab would move the focus to the widget after the field, and the keys typed next would
    /// press that.
    fn take_tab_from_text(&self, ui: &Ui) {
        let context = ui.ctx();
        let is_tab = |event: &Event| matches!(event, Event::Key { key: Key::Tab, pressed: true, modifiers, .. } if modifiers.is_none());
        let is_pressed = context.input(|input| input.events.iter().any(is_tab));
        let scope = self.keyboard.scope();
        let command = self.keys.command(scope, Modifiers::NONE, Key::Tab);
        if !is_pressed || command.is_none_or(|command| command.scope() != scope) || !context.text_edit_focused() {
            return;
        }
        let focused = context.memory(|memory| memory.focused());
        let field = focused.and_then(|id| context.read_response(id));
        // Fields of dialogs and menus lie over the panels, and keep the keyboard.
        let field = field.filter(|field| field.layer_id == ui.layer_id());
        let is_in = |field: &Response| {
            let active = self.dock.rects.get(&self.keyboard.active);
            active.is_some_and(|panel| panel.contains(field.rect.center()))
        };
        if field.is_some_and(|field| !is_in(&field)) {
            context.memory_mut(|memory| {
                memory.stop_text_input();
                memory.move_focus(FocusDirection::None);
            });
        }
    }

    /// Returns whether Escape has an effect elsewhere: it ends typing or a drag out of a panel, or closes a menu.
    fn is_escape_spent(&self, context: &Context, views: &Views) -> bool {
        let is_dropped = context.drag_stopped_id().is_some() && !views.canvas.is_busy();
        self.keyboard.was_typing || is_dropped || Popup::is_any_open(context)
    }

    /// Actions of keys that have no effect in the text field that has the keyboard focus.
    fn keys_beside_text(&self, ui: &Ui) -> Vec<Action> {
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

    /// Returns whether the clipboard is pasted into the graph: on request, or by the usual key while the canvas is
    /// active.
    fn pastes_here(&mut self) -> bool {
        let requested = self.keyboard.paste_requested.take();
        let is_requested = requested.is_some_and(|at| at.elapsed() < PASTE_WITHIN);
        let usual = self.keys.command(Scope::Canvas, Modifiers::COMMAND, Key::V);
        let is_usual = usual == Some(Command::Graph(GraphCommand::Paste));
        is_requested || self.keyboard.active == Panel::Canvas && is_usual
    }

    /// Action of a key.
    fn key(&self, key: Key, modifiers: Modifiers, context: &Context) -> Option<Action> {
        let active = self.keyboard.active;
        // A widget that has the keyboard focus handles the keys that change it.
        let focused = context.memory(|memory| memory.focused());
        let is_ours = focused.is_none_or(|id| id == focus_id() || id == anchor_id(active));
        if let Some(command) = self.keys.command(self.keyboard.scope(), modifiers, key)
            && (is_ours || command.scope() == Scope::Window)
        {
            return Some(Action::Do(command));
        }
        if active != Panel::Canvas || modifiers.any() || !is_ours {
            return None;
        }
        let arrow = match key {
            Key::ArrowLeft => ArrowKey::Left,
            Key::ArrowRight => ArrowKey::Right,
            Key::ArrowUp => ArrowKey::Up,
            Key::ArrowDown => ArrowKey::Down,
            _ => return None,
        };
        Some(Action::Arrow(arrow))
    }

    /// Makes the panel under the pointer the active one as soon as the pointer moves.
    fn follow_pointer(&mut self, ui: &Ui) {
        let (at, has_moved) = ui.input(|input| {
            let is_event = |event: &Event| matches!(event, Event::PointerMoved(_) | Event::PointerButton { .. });
            (input.pointer.hover_pos(), input.events.iter().any(is_event))
        });
        if let Some(at) = at.filter(|_| has_moved)
            && let Some((panel, _)) = self.dock.rects.iter().find(|(_, rect)| rect.contains(at))
            && self.keyboard.active != *panel
        {
            self.keyboard.active = *panel;
            // A widget in another panel loses the keyboard focus; a text field keeps it.
            if !ui.ctx().text_edit_focused() {
                ui.memory_mut(Memory::stop_text_input);
            }
        }
    }

    /// Keeps the keyboard focus on the canvas while it is active, so that Tab and the arrow keys do not move the focus
    /// between widgets.
    fn keep_focus(&self, context: &Context) {
        let id = focus_id();
        // Assistive technology cannot follow a focus on a widget that is not drawn.
        let is_canvas = self.keyboard.active == Panel::Canvas && self.dock.is_shown(Panel::Canvas);
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

    /// Makes a shown panel active if the active one is hidden.
    pub(crate) fn leave_hidden_panel(&mut self, views: &mut Views) {
        if !self.dock.is_shown(self.keyboard.active)
            && let Some(shown) = self.dock.shown().next()
        {
            self.keyboard.active = shown;
        }
        if !self.dock.is_shown(Panel::Canvas) {
            views.canvas.cancel_all();
            self.context.memory_mut(|memory| memory.surrender_focus(focus_id()));
        }
    }

    /// Makes the next or the previous panel active.
    pub(crate) fn step_panel(&mut self, is_on: bool) {
        let shown: Vec<Panel> = self.dock.shown().collect();
        let Some(now) = shown.iter().position(|panel| *panel == self.keyboard.active) else {
            return;
        };
        let next = if is_on { now + 1 } else { now + shown.len() - 1 } % shown.len();
        let panel = shown[next];
        self.keyboard.active = panel;
        self.context.memory_mut(Memory::stop_text_input);
        if panel != Panel::Canvas {
            self.context.memory_mut(|memory| memory.request_focus(anchor_id(panel)));
        }
        self.notify(format!("Keys are for: {}", panel.title()));
    }
}
