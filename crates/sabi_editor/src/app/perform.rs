//! The one place where actions are performed. No match here has a wildcard: an action or a command that is not handled does
//! not compile.

mod commands;
mod dropping;
mod packing;
mod painting;
mod stroke_clipboard;

use std::path::Path;

use egui::{Color32, Rgba, Ui};
use sabi_editing::command::{
    EditCommand, ExposedCommand, KnobCommand, NodeCommand, NodeSource, Outcome, PortCommand, WireCommand, perform,
};
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{OpenDocument, history, knob_target, navigation, node_paths, nodes, relative_paths};
use sabi_graph::{NodeId, SlotRef, Value};
use sabi_nodes::kind::Role;

use super::{Editor, trust};
use crate::action::{Action, ArrowKey, ClickedColor, ExportAction, FileAction, ModelAction, TrustAction};
use crate::dock::Panel;
use crate::files::new_graph;
use crate::knobs::KnobEvent;
use crate::shown_results::{ColorTarget, result_of};

impl Editor {
    /// Performs the actions of a frame, and what follows from them.
    pub(super) fn perform_all(&mut self, actions: Vec<Action>, ui: &Ui) {
        let length = self.looks.length.take();
        for action in actions {
            self.perform(action, ui);
        }
        // The viewport was drawn before the length changed.
        if self.looks.length != length {
            ui.ctx().request_repaint();
        }
        let is_dirty = self.documents.document.session.is_dirty();
        if let Some(next) = self.views.questions.take_next(is_dirty) {
            self.proceed(next);
        }
        for sentence in self.documents.document.take_notices() {
            self.shell.notify(sentence);
        }
    }

    /// Performs an action.
    pub(super) fn perform(&mut self, action: Action, ui: &Ui) {
        let document = &mut self.documents.document;
        match action {
            Action::Do(command) => self.command(command, ui),
            Action::Edit(command) => self.edit(command, ui),
            Action::Notice(sentence) => self.shell.notify(sentence),
            Action::AddInMiddle(new) => {
                let place = self.views.canvas.camera.center();
                self.add_uncovering(new, place, ui);
            }
            Action::DragNew { interface, at } => self.drag_new(&interface, at, ui),
            Action::DropNew { new, interface, at } => self.drop_new(new, &interface, at, ui),
            Action::AddToLibrary(library) => self.save_to_library(library),
            Action::SaveNode(node) => self.save_node(&node),
            Action::Replace { node, by } => self.replace(node, by),
            Action::Select(ids) => self.select(ids),
            Action::Arrow(key) => self.follow_arrow(key, ui),
            Action::Show { node, port } => self.looks.show(document, &node, port),
            Action::ShowChannel { node, mode } => {
                self.looks.show(document, &node, None);
                self.shell.settings.follows = true;
                self.views.model.shot.mode = mode;
            }
            Action::Pin { node } => self.looks.toggle_pin_2d(document, &node),
            Action::Look(action) => self.looks.perform(action, &mut self.shell.settings),
            Action::Knob { node, event } => self.change_knob(node, event, ui),
            Action::TurnExposed(event) => self.change_exposed_value(event, ui),
            Action::SaveVariant(name) => self.pictures().save_variant(name),
            Action::File(action) => self.perform_on_file(action),
            Action::Model(action) => self.perform_on_model(action),
            Action::Trust(action) => self.perform_on_trust(action),
            Action::Dropped(path) => self.take_dropped(&path, ui),
            Action::ImportPictures(path) => self.import_pictures(&path, ui),
            Action::ShowSet(set) => self.views.flat.set = Some(set),
            Action::GoTo(node) => self.go_to(&node),
            Action::Steps(steps) => {
                for _ in 0..steps.unsigned_abs() {
                    match steps < 0 {
                        true => history::undo(document),
                        false => history::redo(document),
                    }
                }
            }
            Action::Export(action) => self.perform_export(action),
            Action::TakeColor(color) => self.take_color(color),
            Action::SetGradient { parameter, stops } => {
                knob_target::set(document, &parameter, stops);
            }
            Action::AskForGradient(parameter) => self.ask_for_gradient(parameter),
            Action::Paint(action) => self.perform_painting(action, ui),
            Action::Setting(action) => self.shell.set(action),
            Action::ShowPanel(panel) => self.shell.dock.bring_up(panel),
            Action::Arrange(workspace) => self.shell.dock.arrange(workspace),
            Action::ShowStartPage => self.views.start.is_open = true,
        }
    }

    fn perform_on_file(&mut self, action: FileAction) {
        match action {
            FileAction::Ask(next) => {
                let is_dirty = self.documents.document.session.is_dirty();
                self.views.questions.ask_next(is_dirty, next);
            }
            FileAction::Proceed(next) => self.proceed(next),
            FileAction::Save => self.saving().save(),
            FileAction::SaveAs(file) => self.saving().save_as(file),
            FileAction::Overwrite(file) => self.saving().save_to(&file),
            FileAction::SaveBesideTheirs => self.saving().save_beside_theirs(),
            FileAction::AllowSaving => self.documents.document.session.graph_file.set_read_only(false),
            FileAction::Pack(file) => self.pack_into(file),
            FileAction::AskForMissing(lost) => {
                self.views.questions.ask_for_missing(&self.documents.document, lost);
            }
            FileAction::Find { lost, file } => self.models().find_missing(&lost, &file),
            FileAction::Reload => self.models().reload(),
            FileAction::KeepOpen => {
                self.documents.is_file_foreign = false;
                self.documents.document.session.graph_file.keep_document();
                self.documents.autosave.invalidate();
            }
            FileAction::DeleteRecovery(at) => {
                let recoveries = &mut self.documents.recoveries.found;
                if at < recoveries.len() {
                    recoveries.remove(at).forget();
                }
            }
            FileAction::AskForPicture => self.views.questions.ask_for_picture(&self.documents.document),
            FileAction::SavePicture(file) => self.views.model.saved_picture.save_to(file),
            FileAction::SetImage { parameter, file } => set_image(&mut self.documents.document, &parameter, &file),
            FileAction::PickGradient { parameter, file } => {
                let context = self.shell.context.clone();
                self.views.gradient_picker.open(&context, parameter, file);
            }
        }
    }

    fn perform_on_model(&mut self, action: ModelAction) {
        match action {
            ModelAction::Ask => self.views.questions.ask_for_model(self.evaluation.model.file()),
            ModelAction::Show(path) => self.models().take_chosen(&path),
            ModelAction::Read(reading) => self.models().read(reading),
            ModelAction::CancelReading => self.models().cancel_reading(),
            ModelAction::Remove(path) => self.models().remove(&path),
            ModelAction::AskBeside => self.views.questions.ask_for_model_beside(self.evaluation.model.file()),
            ModelAction::ShowBeside(path) => self.models().show_chosen_beside(&path),
            ModelAction::RemoveBeside(path) => self.row.remove(&path, &self.shell.context),
        }
    }

    /// Performs an action about trust. Trusted paths hold for this graph and all later ones.
    fn perform_on_trust(&mut self, action: TrustAction) {
        match action {
            TrustAction::Folder(folder) => {
                trust::trust_path(&mut self.documents, &mut self.shell.settings, &folder);
                self.models().take_named();
            }
            TrustAction::Nodes(folder) => trust::trust_nodes(&mut self.documents, &mut self.shell, &folder),
            TrustAction::LeaveNodes => self.documents.leaves_nodes = true,
        }
    }

    fn perform_export(&mut self, action: ExportAction) {
        match action {
            ExportAction::Start { force } => self.export(force),
            ExportAction::Cancel => self.exports.cancel(),
            ExportAction::Choose(choices) => self.shell.settings.export = choices,
            ExportAction::Target(place) => {
                self.exports.asks_force &= place.folder == self.exports.place.folder;
                self.exports.place = place;
            }
        }
    }

    /// Selects nodes; without any, the model shows the outputs again.
    fn select(&mut self, ids: Vec<NodeId>) {
        if ids.is_empty() {
            self.looks.show_material(&self.documents.document);
        }
        self.documents.document.select(ids);
    }

    /// Goes to the node or the port that an arrow key leads to.
    fn follow_arrow(&mut self, key: ArrowKey, ui: &Ui) {
        for action in self.views.canvas.arrow(&self.documents.document, key) {
            self.perform(action, ui);
        }
    }

    /// Edits the open document: shows the result of a node that was added, and puts copied nodes on the clipboard.
    pub(in crate::app) fn edit(&mut self, command: impl Into<EditCommand>, ui: &Ui) {
        let are_first = new_graph::is_untouched(self.documents.document.graph());
        let command = command.into();
        let before = finds_places(&command).then(|| self.views.canvas.camera.before_addition(&self.documents.document));
        match perform(&mut self.documents.document, command) {
            Outcome::Added(id) => {
                let document = &self.documents.document;
                self.looks.show(document, &id, None);
                self.views.canvas.camera.reveal(document, &id, are_first);
                self.ask_for_file_of(&id);
            }
            Outcome::Copied(text) => ui.ctx().copy_text(text),
            Outcome::Unchanged | Outcome::Done | Outcome::Saved(_) => {}
        }
        if let Some(before) = before {
            self.views.canvas.camera.keep_in_view(&self.documents.document, &before);
        }
    }

    /// Asks for the file of a node that reads one, such as a new Image, while none is chosen.
    fn ask_for_file_of(&mut self, id: &NodeId) {
        let document = &self.documents.document;
        let Some((interface, node)) = document.interface(id).zip(document.node(id)) else {
            return;
        };
        let mut files = interface.knobs.iter().filter(|knob| knob.ty.role == Role::File);
        if let Some(knob) = files.find(|knob| !node.params.contains_key(&knob.name)) {
            self.browse(KnobTarget::of_node(id, knob.name.clone()));
        }
    }

    /// Adds a node by a key or a click, where it covers no other.
    pub(in crate::app) fn add_uncovering(&mut self, source: NodeSource, place: [f32; 2], ui: &Ui) {
        let mut candidates = self.documents.candidates().iter();
        let interface = candidates
            .find(|known| known.new == source)
            .map(|known| known.interface.clone());
        let place = interface.map_or(place, |interface| {
            nodes::uncovered(&self.documents.document, &interface, place)
        });
        self.add(source, place, None, ui);
    }

    /// Adds a node, inserted into a wire if one is given, and shows its result.
    fn add(&mut self, source: NodeSource, place: [f32; 2], into: Option<SlotRef>, ui: &Ui) {
        let command = NodeCommand::Add {
            source,
            place,
            pending: None,
            into,
        };
        self.edit(command, ui);
    }

    /// Replaces a node, also wherever its result is shown.
    fn replace(&mut self, node: NodeId, by: NodeSource) {
        let document = &mut self.documents.document;
        let before = node_paths::full_id(document, &node);
        if let Outcome::Added(id) = perform(document, NodeCommand::Replace { node, by }.into()) {
            self.looks.replace(&before, &result_of(document, &id, None));
        }
    }

    /// Changes a parameter of a node, and of the selected nodes of its kind.
    fn change_knob(&mut self, node: NodeId, event: KnobEvent, ui: &Ui) {
        match event {
            KnobEvent::Set { knob, value } => {
                let value = Some(value);
                self.edit(KnobCommand::Set { node, knob, value }, ui);
            }
            KnobEvent::Reset { knob } => {
                let value = None;
                self.edit(KnobCommand::Set { node, knob, value }, ui);
            }
            KnobEvent::Expose { knob } => self.edit(KnobCommand::Expose { node, knob }, ui),
            KnobEvent::Unexpose { knob } => self.edit(KnobCommand::Unexpose { node, knob }, ui),
            KnobEvent::AddMask { knob: name } => {
                self.shell.dock.bring_up(Panel::Canvas);
                let document = &self.documents.document;
                self.views.canvas.ask_for_mask(ui, document, SlotRef { node, name });
            }
            KnobEvent::RemoveMask { knob: name } => self.edit(WireCommand::RemoveMask(SlotRef { node, name }), ui),
            KnobEvent::ExposeMask { knob: name } => self.edit(PortCommand::ExposeInput(SlotRef { node, name }), ui),
            KnobEvent::Eyedropper { knob } => {
                self.toggle_color_target(ColorTarget::Parameter(KnobTarget::of_node(&node, knob)));
            }
            KnobEvent::Browse { knob } => self.browse(KnobTarget::of_node(&node, knob)),
            KnobEvent::PickGradient { knob } => self.ask_for_gradient(KnobTarget::of_node(&node, knob)),
            KnobEvent::Began => self.begin_drag(),
            KnobEvent::Ended => self.end_drag(),
            KnobEvent::Canceled => self.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
        }
    }

    /// Changes the value of an exposed parameter.
    fn change_exposed_value(&mut self, event: KnobEvent, ui: &Ui) {
        match event {
            KnobEvent::Set { knob: name, value } => self.edit(ExposedCommand::Set { name, value }, ui),
            KnobEvent::Reset { knob } => self.edit(ExposedCommand::Reset(knob), ui),
            KnobEvent::Unexpose { knob } => self.edit(ExposedCommand::Remove(knob), ui),
            KnobEvent::Eyedropper { knob } => {
                self.toggle_color_target(ColorTarget::Parameter(KnobTarget::Exposed(knob)));
            }
            KnobEvent::Browse { knob } => self.browse(KnobTarget::Exposed(knob)),
            KnobEvent::PickGradient { knob } => self.ask_for_gradient(KnobTarget::Exposed(knob)),
            KnobEvent::Began => self.begin_drag(),
            KnobEvent::Ended => self.end_drag(),
            KnobEvent::Canceled => self.cancel_drag(),
            KnobEvent::ShowLength(length) => self.looks.length = Some(length).filter(|length| length.is_finite()),
            // A parameter of the panel is exposed already, and its masks are linked at the nodes.
            KnobEvent::Expose { .. }
            | KnobEvent::AddMask { .. }
            | KnobEvent::RemoveMask { .. }
            | KnobEvent::ExposeMask { .. } => {}
        }
    }

    fn browse(&mut self, parameter: KnobTarget) {
        let document = &self.documents.document;
        self.views.questions.ask_for_image(document, parameter);
    }

    fn ask_for_gradient(&mut self, parameter: KnobTarget) {
        let document = &self.documents.document;
        self.views.questions.ask_for_gradient(document, parameter);
    }

    /// Begins the drag of a parameter: all of it is one step to undo, and results are quick meanwhile.
    fn begin_drag(&mut self) {
        self.documents.document.session.begin("");
        self.documents.is_dragging = true;
    }

    /// Ends the drag of a parameter, unless it has ended already because its row disappeared.
    fn end_drag(&mut self) {
        if self.documents.is_dragging {
            self.documents.document.session.end();
            self.documents.is_dragging = false;
        }
    }

    /// Cancels the drag of a parameter.
    fn cancel_drag(&mut self) {
        history::cancel_step(&mut self.documents.document);
        self.documents.is_dragging = false;
    }

    fn toggle_color_target(&mut self, target: ColorTarget) {
        if self.looks.toggle_color_target(target) {
            self.shell
                .notify("Click the color on the model or in the 2D view. Escape cancels.");
        }
    }

    /// Gives a clicked color to the parameter or the brush that waits for one. After a click without a color, it still
    /// waits.
    fn take_color(&mut self, color: ClickedColor) {
        let Some([red, green, blue]) = self.shell.allow(color) else {
            return;
        };
        match self.looks.color_target.take() {
            Some(ColorTarget::Parameter(parameter)) => {
                let text = format!("#{red:02x}{green:02x}{blue:02x}");
                knob_target::set(&mut self.documents.document, &parameter, Value::Text(text));
            }
            Some(ColorTarget::Brush) => {
                let [red, green, blue, _] = Rgba::from(Color32::from_rgb(red, green, blue)).to_array();
                self.shell.settings.brush.color = [red, green, blue];
            }
            None => {}
        }
    }

    /// Selects a node in the group that it is in, and shows it on the canvas.
    fn go_to(&mut self, node: &str) {
        let document = &mut self.documents.document;
        let Some(id) = navigation::go_to(document, node) else {
            return;
        };
        self.shell.dock.bring_up(Panel::Canvas);
        self.views.canvas.camera.frame_nodes(document, [&id].into_iter());
        self.looks.show(document, &id, None);
    }
}

/// Gives an image file to a parameter.
fn set_image(document: &mut OpenDocument, parameter: &KnobTarget, file: &Path) {
    match relative_paths::chosen(document, file) {
        Ok(text) => {
            knob_target::set(document, parameter, Value::Text(text));
        }
        Err(refused) => document.notify(refused.to_string()),
    }
}

/// Returns whether a command looks for free places for its new nodes, rather than adding them where the artist chose.
fn finds_places(command: &EditCommand) -> bool {
    matches!(
        command,
        EditCommand::Layer(_) | EditCommand::Node(NodeCommand::AddTextureSets { .. })
    )
}
