//! All keys, by where they act, to be taken away and added to; and what is dragged with the mouse.

use egui::{Event, Key, Response, RichText, Ui, WidgetInfo, WidgetType, Window};
use egui_phosphor::regular as icon;

use crate::app::{Editor, told_by_system};
use crate::command::{Command, Scope};
use crate::key_map::Chord;
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

/// One command with its keys: a click on one takes it away, and another one can be added. Says whether any changed.
fn row(editor: &mut Editor, ui: &mut Ui, command: Command) -> bool {
    ui.label(command.title());
    let before: Vec<Chord> = editor.keys().chords(command).collect();
    let mut chords = before.clone();
    let mut is_reset = false;
    ui.horizontal(|ui| {
        chords.retain(|chord| {
            let text = chord.text();
            let button = named(ui.button(RichText::new(&text).monospace()), || {
                format!("Take {text} from {}", command.title())
            });
            !button.on_hover_text("Take this key away").clicked()
        });
        chords.extend(added(editor, ui, command));
        let is_own = editor.settings.keys.contains_key(command.name());
        if is_own {
            let button = named(ui.button(icon::ARROW_COUNTER_CLOCKWISE), || {
                format!("The first keys of {}", command.title())
            });
            is_reset = button.on_hover_text("As they were at first").clicked();
        }
    });
    let is_changed = chords != before;
    let keys = &mut editor.settings.keys;
    if is_reset {
        keys.remove(command.name());
    } else if is_changed {
        let texts = chords.into_iter().map(Chord::text).collect();
        keys.insert(command.name().to_owned(), texts);
    }
    is_reset || is_changed
}

/// The button that waits for another key of a command, and the key that was pressed then. Escape leaves it.
fn added(editor: &mut Editor, ui: &mut Ui, command: Command) -> Option<Chord> {
    let is_waiting = editor.waits_for_key == Some(command);
    let text = if is_waiting {
        "Press a key, or Esc…"
    } else {
        icon::PLUS
    };
    let button = named(ui.button(text), || format!("Add a key for {}", command.title()));
    if button.on_hover_text("Another key for the same").clicked() {
        editor.waits_for_key = if is_waiting { None } else { Some(command) };
    }
    if !is_waiting {
        return None;
    }
    let chord = ui.input(|input| input.events.iter().find_map(pressed))?;
    editor.waits_for_key = None;
    let is_known = editor
        .keys()
        .chords(command)
        .any(|known| known.is(chord.modifiers, chord.key));
    Some(chord).filter(|chord| chord.key != Key::Escape && !is_known)
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
        event => told_by_system(event),
    }
}

fn named(button: Response, name: impl Fn() -> String) -> Response {
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name()));
    button
}
