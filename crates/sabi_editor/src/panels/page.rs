//! The page of the selected node: what it is, what it takes and gives, and the file that it is.

mod code;
mod draft;

use egui::{RichText, Ui};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};
use sabi_engine::catalog::{Entry, Port};

use crate::action::Action;
use crate::app::Editor;
use crate::desk::Desk;
use crate::theme::Theme;
pub(crate) use draft::Draft;

/// What the page holds from frame to frame.
#[derive(Default)]
pub(crate) struct Page {
    markdown: CommonMarkCache,
    shows_source: bool,
    /// The node file that is being written.
    pub(crate) draft: Option<Draft>,
}

impl Page {
    /// Whether a node file is being written that nothing holds yet.
    pub(crate) fn is_unsaved(&self) -> bool {
        self.draft.as_ref().is_some_and(|draft| !draft.is_saved)
    }
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let Editor { desk, panels, .. } = editor;
    let page = &mut panels.page;
    if let Some(draft) = &mut page.draft {
        if draft.show(ui, theme, desk, actions) {
            page.draft = None;
        }
        return;
    }
    let face = desk.selected_one().and_then(|id| desk.face(id)).cloned();
    let Some(face) = face else {
        ui.colored_label(theme.quiet, "Select a node to read what it does.");
        return;
    };
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.heading(&face.label);
            ui.colored_label(theme.quiet, RichText::new(&face.id).monospace());
        });
        ui.label(&face.summary);
        if let Some(text) = &face.source {
            file(ui, theme, desk, page, &face.id, text);
        }
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
    });
}

/// The file that a node is, and the ways to write one.
fn file(ui: &mut Ui, theme: &Theme, desk: &mut Desk, page: &mut Page, id: &str, text: &str) {
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        ui.toggle_value(&mut page.shows_source, "The file");
        if let Some(own) = desk.kinds().0.own_folder(desk.session.file(), id) {
            let change = ui
                .button("Change it")
                .on_hover_text(format!("It lies in {}", own.display()));
            if change.clicked() {
                match Draft::of_own(desk, id) {
                    Ok(draft) => page.draft = Some(draft),
                    Err(why) => desk.say(why),
                }
            }
        }
        let new = ui.button("New node from here");
        if new.on_hover_text("Copies the file to a node of your own").clicked() {
            page.draft = Draft::like(desk, id, text);
            if page.draft.is_none() {
                desk.say("This system has no folder for nodes; save the graph first, so that there is one beside it.");
            }
        }
    });
    if page.shows_source {
        code::show(ui, theme, text);
    }
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
