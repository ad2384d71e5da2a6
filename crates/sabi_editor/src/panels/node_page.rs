//! The page of the selected node: description, ports, parameters and file.

mod code;
mod draft_editor;
mod tutorial;

use egui::{ColorImage, RichText, TextureHandle, TextureOptions, Ui, WidgetInfo, WidgetType};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};
use egui_phosphor::regular as icon;
use sabi_editing::OpenDocument;
use sabi_engine::catalog::node_file::NodeDraft;
use sabi_engine::catalog::{Interface, Port, picture_of};

use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::theme::{Theme, space};
pub(crate) use draft_editor::DraftEditor;
use draft_editor::EditorState;

/// Pixels along the side of a picture.
const PICTURE_SIDE: u32 = 240;

/// Panel of the selected node's page, or of a node file that is being written.
#[derive(Default)]
pub(crate) struct NodePage {
    markdown: CommonMarkCache,
    shows_source: bool,
    /// Node kind whose picture is loaded, and the picture if it has one.
    picture: Option<(String, Option<TextureHandle>)>,
    /// Node files that are being written.
    drafts: Vec<DraftEditor>,
    /// Index of the node file that is shown in place of the selected node.
    shown: Option<usize>,
    /// Rises when a draft is opened, saved or closed.
    revision: u64,
    shows_tutorial: bool,
    /// Text of the tutorial, once it was shown.
    tutorial: String,
}

impl NodePage {
    /// A page with node files that are being written.
    pub(crate) fn with_drafts(drafts: Vec<DraftEditor>) -> NodePage {
        NodePage {
            drafts,
            ..NodePage::default()
        }
    }

    /// Shows the selected node; node files that are being written stay open.
    pub(crate) fn show_node(&mut self) {
        self.shown = None;
        self.shows_tutorial = false;
    }

    /// Shows the tutorial until it is closed.
    pub(crate) fn show_tutorial(&mut self) {
        self.shows_tutorial = true;
    }

    /// Marks the drafts with this text as saved.
    pub(crate) fn saved(&mut self, node: &NodeDraft) {
        for draft in self.drafts.iter_mut().filter(|draft| draft.node() == node) {
            draft.was_saved();
        }
        self.revision += 1;
    }

    /// Revision of the unsaved drafts.
    pub(crate) fn revision(&self) -> u64 {
        self.revision + self.drafts.iter().map(DraftEditor::edits).sum::<u64>()
    }

    /// Node files with changes that are not saved.
    pub(crate) fn unsaved(&self) -> Vec<NodeDraft> {
        let unsaved = self.drafts.iter().filter(|draft| draft.is_unsaved());
        unsaved.map(|draft| draft.node().clone()).collect()
    }

    /// Opens node files that were not saved when the program ended.
    pub(crate) fn recover(&mut self, drafts: Vec<NodeDraft>, document: &OpenDocument) {
        for draft in drafts {
            let draft = DraftEditor::recovered(document, draft);
            // A draft with unsaved changes stays open beside the recovered one.
            self.drafts.retain(|known| known.is_unsaved() || !known.is_like(&draft));
            self.shown = Some(self.drafts.len());
            self.drafts.push(draft);
        }
        self.revision += 1;
    }

    /// Shows the first node file with unsaved changes. Returns whether there is one.
    pub(crate) fn show_unsaved(&mut self) -> bool {
        let unsaved = self.drafts.iter().position(DraftEditor::is_unsaved);
        self.shown = unsaved.or(self.shown);
        unsaved.is_some()
    }

    /// Node files that are being written.
    pub(crate) fn take_drafts(&mut self) -> Vec<DraftEditor> {
        std::mem::take(&mut self.drafts)
    }

    /// Shows a draft, or the open one of the same node.
    fn open(&mut self, draft: DraftEditor) {
        let known = self.drafts.iter().position(|known| known.is_like(&draft));
        self.shown = Some(known.unwrap_or(self.drafts.len()));
        if known.is_none() {
            self.drafts.push(draft);
        }
    }

    /// Picture of the effect of a node.
    fn picture(&mut self, ui: &mut Ui, interface: &Interface) {
        if self.picture.as_ref().is_none_or(|(kind, _)| *kind != interface.id) {
            let picture = picture_of(&interface.id, PICTURE_SIDE).map(|picture| {
                let size = picture.size.map(|side| side as usize);
                let image = ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
                let name = format!("what {} gives", interface.id);
                ui.ctx().load_texture(name, image, TextureOptions::LINEAR)
            });
            self.picture = Some((interface.id.clone(), picture));
        }
        if let Some((_, Some(picture))) = &self.picture {
            let side = ui.available_width().min(PICTURE_SIDE as f32);
            let image = egui::Image::new((picture.id(), egui::Vec2::splat(side)));
            ui.add(
                image
                    .corner_radius(space::CORNER)
                    .alt_text(format!("What {} gives", interface.label)),
            );
        }
    }

    /// Shows the file that defines a node, and the buttons that begin to write one. Returns a sentence if that is not
    /// possible.
    fn file(&mut self, ui: &mut Ui, context: &ViewContext<'_>, id: &str, text: &str) -> Option<String> {
        let document = context.document;
        let mut refused = None;
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            ui.toggle_value(&mut self.shows_source, "Source code");
            if let Some(own) = document.node_kinds().kinds.own_folder(document.session.file(), id) {
                let change = ui.button("Edit").on_hover_text(format!("File: {}", own.display()));
                if change.clicked() {
                    match DraftEditor::of_own(document, id) {
                        Ok(draft) => self.open(draft),
                        Err(why) => refused = Some(why),
                    }
                }
            }
            let new = ui.button("Copy as a node of my own");
            if new.on_hover_text("Copies the file to a node of your own").clicked() {
                let missing =
                    "This system has no folder for nodes; save the graph first, so that there is one beside it.";
                match DraftEditor::like(document, id, text) {
                    Some(draft) => self.open(draft),
                    None => refused = Some(missing.to_owned()),
                }
            }
        });
        if self.shows_source {
            code::show(ui, context.theme, text);
        }
        refused
    }

    /// Buttons that show the drafts.
    fn draft_buttons(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            for (at, draft) in self.drafts.iter().enumerate() {
                let text = format!("{} {}", icon::PENCIL_SIMPLE, draft.id());
                let way = ui.button(text).on_hover_text("A node file that is being written");
                way.widget_info(|| {
                    WidgetInfo::labeled(WidgetType::Button, true, format!("Continue editing {}", draft.id()))
                });
                if way.clicked() {
                    self.shown = Some(at);
                }
            }
        });
    }
}

impl View for NodePage {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let (document, theme) = (context.document, context.theme);
        let mut actions = Vec::new();
        if self.shows_tutorial {
            self.shows_tutorial = !tutorial::show(ui, &mut self.markdown, &mut self.tutorial);
            return actions;
        }
        if let Some((at, draft)) = self.shown.and_then(|at| Some((at, self.drafts.get_mut(at)?))) {
            match draft.show(ui, theme, document, &mut actions) {
                EditorState::Shown => {}
                EditorState::Hidden => self.shown = None,
                EditorState::Closed => {
                    self.revision += self.drafts.remove(at).edits() + 1;
                    self.shown = None;
                }
            }
            return actions;
        }
        self.draft_buttons(ui);
        let Some(interface) = document.selected_one().and_then(|id| document.interface(id)) else {
            ui.colored_label(theme.quiet, "Select a node to read what it does.");
            return actions;
        };
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.heading(&interface.label);
                ui.colored_label(theme.quiet, RichText::new(&interface.id).monospace());
            });
            ui.label(&interface.summary);
            if let Some(text) = &interface.source {
                let refused = self.file(ui, context, &interface.id, text);
                actions.extend(refused.map(Action::Notice));
            }
            self.picture(ui, interface);
            if !interface.description.is_empty() {
                CommonMarkViewer::new().show(ui, &mut self.markdown, &interface.description);
            }
            ports(ui, theme, "Inputs", &interface.inputs);
            ports(ui, theme, "Outputs", &interface.outputs);
            knobs(ui, theme, interface);
            if !interface.aliases.is_empty() {
                ui.add_space(8.0);
                ui.colored_label(theme.quiet, format!("Also called {}", interface.aliases.join(", ")));
            }
        });
        actions
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

fn knobs(ui: &mut Ui, theme: &Theme, interface: &Interface) {
    let own: Vec<_> = interface.knobs.iter().filter(|knob| !knob.is_of_input).collect();
    if own.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong("Parameters");
    for knob in own {
        ui.horizontal_wrapped(|ui| {
            ui.label(&knob.label);
            ui.monospace(&knob.name);
            ui.colored_label(theme.quiet, &knob.doc);
        });
    }
}
