//! The start page: what was open, examples, and what was not saved when the program last ended.

use std::time::SystemTime;

use egui::{Align2, Color32, FontId, Modal, RichText, Sense, Ui, vec2};

use egui_phosphor::regular as icon;

use super::Next;
use super::examples::EXAMPLES;
use crate::action::Action;
use crate::app::Editor;
use crate::command::{Command, FileCommand};
use crate::theme::{Theme, space, type_size};

pub(super) fn show(editor: &mut Editor, ui: &Ui, actions: &mut Vec<Action>) {
    if !editor.files.is_start || editor.question().is_some() {
        return;
    }
    let theme = editor.theme().clone();
    let mut next = None;
    let mut is_over = false;
    let modal = Modal::new(egui::Id::new("start")).show(ui.ctx(), |ui| {
        ui.set_width(720.0);
        ui.horizontal(|ui| {
            ui.label(
                RichText::new(icon::DIAMONDS_FOUR)
                    .color(theme.accent)
                    .size(type_size::TITLE),
            );
            ui.label(RichText::new("Sabi").size(type_size::TITLE));
            ui.colored_label(theme.quiet, "materials that age, on real models");
        });
        ui.add_space(space::WIDE);
        recoveries(editor, ui, &theme, &mut next);
        ui.columns(2, |columns| {
            let [left, right] = columns else { return };
            left.strong("Begin");
            if card(left, &theme, "Empty graph", "Begin with nothing but a model") {
                next = Some(Next::New);
            }
            if card(left, &theme, "Open…", "A graph of yours") {
                actions.push(Action::Do(Command::File(FileCommand::Open)));
                is_over = true;
            }
            left.add_space(space::USUAL);
            if !editor.settings.recent.is_empty() {
                left.strong("Lately");
            }
            for path in editor.settings.recent.iter().take(5) {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                if card(left, &theme, &name, &path.display().to_string()) {
                    next = Some(Next::Open(path.clone()));
                }
            }
            right.strong("Examples");
            for (at, example) in EXAMPLES.iter().enumerate() {
                if card(right, &theme, example.title, example.says) {
                    next = Some(Next::Example(at));
                }
            }
        });
    });
    if next.is_some() || is_over || modal.should_close() {
        editor.files.is_start = false;
    }
    if let Some(next) = next {
        let Editor { files, document, .. } = editor;
        files.ask_next(document, next);
    }
}

fn recoveries(editor: &mut Editor, ui: &mut Ui, theme: &Theme, next: &mut Option<Next>) {
    if editor.files.recoveries.is_empty() {
        return;
    }
    ui.colored_label(theme.warning, "The program ended before this was saved:");
    let mut gone = None;
    for (at, recovery) in editor.files.recoveries.iter().enumerate() {
        let of = recovery
            .file()
            .map_or("a graph without a file".to_owned(), |file| file.display().to_string());
        ui.horizontal_wrapped(|ui| {
            match recovery.fault() {
                Some(fault) => {
                    ui.colored_label(theme.fault, fault.to_string());
                }
                None => {
                    if recovery.has_graph() {
                        ui.label(of);
                    }
                    for draft in recovery.drafts() {
                        ui.label(format!("the node file {}", draft.id));
                    }
                }
            }
            ui.colored_label(theme.quiet, recovery.when().map(told_age).unwrap_or_default());
            if recovery.fault().is_none() && ui.button("Recover").clicked() {
                *next = Some(Next::Recover(at));
            }
            ui.menu_button("Let it go", |ui| {
                ui.label("It cannot be brought back.");
                if ui.button("Let it go for good").clicked() {
                    gone = Some(at);
                }
            });
        });
    }
    if let Some(at) = gone {
        editor.files.recoveries.remove(at).forget();
    }
    ui.add_space(space::WIDE);
}

/// How long ago something was.
fn told_age(when: SystemTime) -> String {
    let minutes = when.elapsed().map_or(0, |age| age.as_secs() / 60);
    match minutes {
        0 => "just now".to_owned(),
        1 => "a minute ago".to_owned(),
        2..120 => format!("{minutes} minutes ago"),
        120..2880 => format!("{} hours ago", minutes / 60),
        _ => format!("{} days ago", minutes / 1440),
    }
}

/// Something to click: a title and a sentence.
fn card(ui: &mut Ui, theme: &Theme, title: &str, says: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 44.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, title));
    let fill = if response.hovered() || response.has_focus() {
        theme.hovered
    } else {
        theme.raised
    };
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, space::CORNER, fill);
    let text = |y: f32, text: &str, size: f32, color: Color32| {
        painter.text(
            rect.left_top() + vec2(12.0, y),
            Align2::LEFT_TOP,
            text,
            FontId::proportional(size),
            color,
        );
    };
    text(6.0, title, type_size::BODY, theme.text);
    text(24.0, says, type_size::SMALL, theme.quiet);
    response.clicked()
}
