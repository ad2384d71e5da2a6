//! All keys, by where they act, each of which can be bound anew; and what is dragged with the mouse.

use egui::{Event, RichText, Ui, Window};

use crate::app::Editor;
use crate::command::{Chord, Command, Scope};
use crate::mouse::grips;

const SCOPES: [(Scope, &str); 4] = [
    (Scope::Window, "Anywhere"),
    (Scope::Canvas, "On the graph"),
    (Scope::Viewport, "On the model"),
    (Scope::Flat, "On the texture"),
];

pub(super) fn show(editor: &mut Editor, ui: &Ui) {
    if !editor.files.shows_keys {
        editor.waits_for_key = None;
        return;
    }
    let mut is_open = true;
    let mut has_changed = false;
    Window::new("Keys")
        .open(&mut is_open)
        .default_size([420.0, 520.0])
        .show(ui.ctx(), |ui| {
            for (chord, [one, other]) in editor.keys().clashes() {
                let text = format!(
                    "{} means both \"{}\" and \"{}\"",
                    chord.text(),
                    one.title(),
                    other.title()
                );
                ui.colored_label(ui.visuals().warn_fg_color, text);
            }
            if ui.button("As they were at first").clicked() {
                editor.settings.keys.clear();
                has_changed = true;
            }
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                for (scope, title) in SCOPES {
                    ui.add_space(8.0);
                    ui.strong(title);
                    egui::Grid::new(title)
                        .num_columns(2)
                        .striped(true)
                        .min_col_width(180.0)
                        .show(ui, |ui| {
                            for command in Command::ALL.iter().filter(|command| command.scope() == scope) {
                                has_changed |= row(editor, ui, *command);
                                ui.end_row();
                            }
                            for grip in grips(editor.settings.habit, scope) {
                                ui.label(grip.drags.title());
                                ui.monospace(grip.text());
                                ui.end_row();
                            }
                        });
                }
            });
        });
    editor.files.shows_keys = is_open;
    if has_changed {
        editor.take_settings(ui.ctx());
    }
}

/// One command with its keys; a click waits for another key.
fn row(editor: &mut Editor, ui: &mut Ui, command: Command) -> bool {
    ui.label(command.title());
    let is_waiting = editor.waits_for_key == Some(command);
    let keys: Vec<String> = editor.keys().chords(command).map(Chord::text).collect();
    let text = if is_waiting {
        "Press a key…".to_owned()
    } else {
        keys.join("   ")
    };
    let text = if text.is_empty() { "–".to_owned() } else { text };
    let button = ui.button(RichText::new(text).monospace());
    button.widget_info(|| {
        egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("Keys for {}", command.title()))
    });
    if button.clicked() {
        editor.waits_for_key = if is_waiting { None } else { Some(command) };
    }
    if !is_waiting {
        return false;
    }
    let pressed = ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } => Some(Chord {
                modifiers: *modifiers,
                key: *key,
            }),
            _ => None,
        })
    });
    let Some(chord) = pressed else { return false };
    editor.waits_for_key = None;
    editor
        .settings
        .keys
        .insert(command.name().to_owned(), vec![chord.text()]);
    true
}
