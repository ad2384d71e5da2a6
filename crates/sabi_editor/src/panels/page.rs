//! The page of the selected node: what it is, what it takes and gives, and the file that it is.

use egui::{RichText, Ui};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};
use sabi_engine::catalog::{Entry, Port};

use crate::app::Editor;
use crate::theme::Theme;

/// What the page holds from frame to frame.
#[derive(Default)]
pub(crate) struct Page {
    markdown: CommonMarkCache,
    shows_source: bool,
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme) {
    let face = editor.desk.selected_one().and_then(|id| editor.desk.face(id)).cloned();
    let Some(face) = face else {
        ui.colored_label(theme.quiet, "Select a node to read what it does.");
        return;
    };
    let page = &mut editor.panels.page;
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.heading(&face.label);
        ui.colored_label(theme.quiet, &face.id);
        ui.label(&face.summary);
        if !face.description.is_empty() {
            CommonMarkViewer::new().show(ui, &mut page.markdown, &face.description);
        }
        ports(ui, theme, "Takes", &face.inputs);
        ports(ui, theme, "Gives", &face.outputs);
        knobs(ui, theme, &face);
        if !face.aliases.is_empty() {
            ui.add_space(8.0);
            ui.colored_label(theme.quiet, format!("Also called {}", face.aliases.join(", ")));
        }
        if let Some(source) = &face.source {
            ui.add_space(8.0);
            ui.toggle_value(&mut page.shows_source, "The file");
            if page.shows_source {
                ui.label(RichText::new(source.as_ref()).monospace());
            }
        }
    });
}

fn ports(ui: &mut Ui, theme: &Theme, title: &str, ports: &[Port]) {
    if ports.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong(title);
    for port in ports {
        ui.horizontal_wrapped(|ui| {
            ui.label(&port.label);
            let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
            ui.colored_label(theme.port(port.ty), carries);
            ui.colored_label(theme.quiet, &port.doc);
        });
    }
}

fn knobs(ui: &mut Ui, theme: &Theme, face: &Entry) {
    let own: Vec<_> = face.knobs.iter().filter(|knob| !knob.is_of_input).collect();
    if own.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong("Knobs");
    for knob in own {
        ui.horizontal_wrapped(|ui| {
            ui.label(&knob.label);
            ui.monospace(&knob.name);
            ui.colored_label(theme.quiet, &knob.doc);
        });
    }
}
