//! The list of keys by scope, where keys are added and removed, and of mouse drags.

use std::collections::BTreeMap;

use egui::{Event, Grid, Key, Response, RichText, ScrollArea, Ui, WidgetInfo, WidgetType, Window};
use egui_phosphor::regular as icon;

use crate::action::{Action, SettingAction};
use crate::command::{Command, Scope};
use crate::context::{View, ViewContext};
use crate::key_map::{Chord, from_clipboard_event};
use crate::mouse::bindings;

const SCOPES: [(Scope, &str); 4] = [
    (Scope::Window, "Anywhere"),
    (Scope::Canvas, "On the graph"),
    (Scope::Viewport, "3D view"),
    (Scope::Flat, "2D view"),
];

/// Window with the list of keys.
#[derive(Default)]
pub(crate) struct KeyList {
    pub(crate) is_open: bool,
    /// Command that takes the next pressed key.
    waiting: Option<Command>,
}

type OwnKeys = BTreeMap<String, Vec<String>>;

impl View for KeyList {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        if !self.is_open {
            self.waiting = None;
            return Vec::new();
        }
        let mut is_open = true;
        let mut own = context.settings.keys.clone();
        Window::new("Keys")
            .open(&mut is_open)
            .default_size([420.0, 520.0])
            .show(ui.ctx(), |ui| self.contents(ui, context, &mut own));
        self.is_open = is_open;
        let is_changed = own != context.settings.keys;
        let change = is_changed.then_some(Action::Setting(SettingAction::Keys(own)));
        change.into_iter().collect()
    }
}

impl KeyList {
    /// Returns whether the next pressed key is assigned to a command.
    pub(crate) fn takes_keys(&self) -> bool {
        self.waiting.is_some()
    }

    fn contents(&mut self, ui: &mut Ui, context: &ViewContext<'_>, own: &mut OwnKeys) {
        for (chord, [one, other]) in context.keys.clashes() {
            let text = format!(
                "{} means both \"{}\" and \"{}\"",
                chord.text(),
                one.title(),
                other.title()
            );
            ui.colored_label(ui.visuals().warn_fg_color, text);
        }
        if ui.button("Reset all keys").clicked() {
            own.clear();
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (scope, title) in SCOPES {
                ui.add_space(8.0);
                ui.strong(title);
                let grid = Grid::new(title).num_columns(2).striped(true).min_col_width(180.0);
                grid.show(ui, |ui| {
                    for command in Command::ALL.iter().filter(|command| command.scope() == scope) {
                        self.row(ui, context, *command, own);
                        ui.end_row();
                    }
                    for binding in bindings(context.settings.input_preset, scope) {
                        ui.label(binding.action.title());
                        ui.monospace(binding.text());
                        ui.end_row();
                    }
                });
            }
        });
    }

    /// Row of a command with its keys: a click on one removes it, and another one can be added.
    fn row(&mut self, ui: &mut Ui, context: &ViewContext<'_>, command: Command, own: &mut OwnKeys) {
        ui.label(command.title());
        let before: Vec<Chord> = context.keys.chords(command).collect();
        let mut chords = before.clone();
        let mut is_reset = false;
        ui.horizontal(|ui| {
            chords.retain(|chord| {
                let text = chord.text();
                let button = named(ui.button(RichText::new(&text).monospace()), || {
                    format!("Take {text} from {}", command.title())
                });
                !button.on_hover_text("Remove this key").clicked()
            });
            chords.extend(self.added(ui, context, command));
            if own.contains_key(command.name()) {
                let button = named(ui.button(icon::ARROW_COUNTER_CLOCKWISE), || {
                    format!("Reset the keys of {}", command.title())
                });
                is_reset = button.on_hover_text("Back to the keys of the preset").clicked();
            }
        });
        if is_reset {
            own.remove(command.name());
        } else if chords != before {
            let texts = chords.into_iter().map(Chord::text).collect();
            own.insert(command.name().to_owned(), texts);
        }
    }

    /// Button that waits for another key of a command, and the key that was pressed then. Escape cancels.
    fn added(&mut self, ui: &mut Ui, context: &ViewContext<'_>, command: Command) -> Option<Chord> {
        let is_waiting = self.waiting == Some(command);
        let text = if is_waiting {
            "Press a key, or Esc…"
        } else {
            icon::PLUS
        };
        let button = named(ui.button(text), || format!("Add a key for {}", command.title()));
        if button.on_hover_text("Add another key").clicked() {
            self.waiting = if is_waiting { None } else { Some(command) };
        }
        if !is_waiting {
            return None;
        }
        let chord = ui.input(|input| input.events.iter().find_map(pressed))?;
        self.waiting = None;
        let mut known = context.keys.chords(command);
        let is_known = known.any(|known| known.is(chord.modifiers, chord.key));
        Some(chord).filter(|chord| chord.key != Key::Escape && !is_known)
    }
}

fn pressed(event: &Event) -> Option<Chord> {
    match event {
        Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } => Some(Chord {
            modifiers: *modifiers,
            key: *key,
        }),
        event => from_clipboard_event(event),
    }
}

fn named(button: Response, name: impl Fn() -> String) -> Response {
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name()));
    button
}
