//! Edits of the open graph, and what the views show of them.

mod pictures;
mod values;

use egui::{Color32, Rgba, Ui};
use sabi_editing::arrangement::{Align, DistributionAxis};
use sabi_editing::command::{
    self as editing, ClipboardCommand, EditCommand, FrameCommand, GroupCommand, HistoryCommand, LayerCommand,
    NavigationCommand, NodeCommand, NodeSource, Outcome, SelectionCommand, WireCommand, perform,
};
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{knob_target, navigation, node_paths, nodes};
use sabi_graph::{NodeId, NodeRows, SlotRef, Value};
use sabi_nodes::kind::Role;

use super::documents::Documents;
use super::drop_targets::DropTarget;
use super::shell::Shell;
use crate::action::ClickedColor;
use crate::command::{ArrangeCommand, Favorite, GraphCommand};
use crate::dock::Panel;
use crate::files::new_graph;
use crate::shown_results::{ColorTarget, ShownResults, result_of};
use crate::views::Views;

/// Edits of the open graph: the views show the result of a node that is added, and ask for what it needs.
pub(super) struct GraphEdits<'a> {
    pub(super) documents: &'a mut Documents,
    pub(super) looks: &'a mut ShownResults,
    pub(super) views: &'a mut Views,
    pub(super) shell: &'a mut Shell,
}

impl GraphEdits<'_> {
    /// Edits the open document: shows the result of a node that was added, and puts copied nodes on the clipboard.
    pub(super) fn edit(&mut self, command: impl Into<EditCommand>, ui: &Ui) {
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
    pub(super) fn add_uncovering(&mut self, source: NodeSource, place: [f32; 2], ui: &Ui) {
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
    pub(super) fn replace(&mut self, node: NodeId, by: NodeSource) {
        let document = &mut self.documents.document;
        let before = node_paths::full_id(document, &node);
        if let Outcome::Added(id) = perform(document, NodeCommand::Replace { node, by }.into()) {
            self.looks.replace(&before, &result_of(document, &id, None));
        }
    }

    /// Selects nodes; without any, the model shows the outputs again.
    pub(super) fn select(&mut self, ids: Vec<NodeId>) {
        if ids.is_empty() {
            self.looks.show_material(&self.documents.document);
        }
        self.documents.document.select(ids);
    }

    fn browse(&mut self, parameter: KnobTarget) {
        let document = &self.documents.document;
        self.views.questions.ask_for_image(document, parameter);
    }

    fn ask_for_gradient(&mut self, parameter: KnobTarget) {
        let document = &self.documents.document;
        self.views.questions.ask_for_gradient(document, parameter);
    }

    pub(super) fn toggle_color_target(&mut self, target: ColorTarget) {
        if self.looks.toggle_color_target(target) {
            self.shell
                .notify("Click the color on the model or in the 2D view. Escape cancels.");
        }
    }

    /// Gives a clicked color to the parameter or the brush that waits for one. After a click without a color, it still
    /// waits.
    pub(super) fn take_color(&mut self, color: ClickedColor) {
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
    pub(super) fn go_to(&mut self, node: &str) {
        let document = &mut self.documents.document;
        let Some(id) = navigation::go_to(document, node) else {
            return;
        };
        self.shell.dock.bring_up(Panel::Canvas);
        self.views.canvas.camera.frame_nodes(document, [&id].into_iter());
        self.looks.show(document, &id, None);
    }

    /// Performs a command about the selected nodes, the clipboard or the shown group.
    pub(super) fn command(&mut self, command: GraphCommand, ui: &Ui) {
        let document = &self.documents.document;
        let edit: EditCommand = match command {
            GraphCommand::Undo => HistoryCommand::Undo.into(),
            GraphCommand::Redo => HistoryCommand::Redo.into(),
            GraphCommand::Delete => NodeCommand::DeleteSelected { reconnects: false }.into(),
            GraphCommand::Heal => NodeCommand::DeleteSelected { reconnects: true }.into(),
            GraphCommand::TakeOut => WireCommand::DetachSelected.into(),
            GraphCommand::SwapInputs => WireCommand::SwapInputs.into(),
            GraphCommand::Mute => NodeCommand::ToggleMuted.into(),
            GraphCommand::Collapse => NodeCommand::ToggleRows(NodeRows::None).into(),
            GraphCommand::HidePorts => NodeCommand::ToggleRows(NodeRows::Wired).into(),
            GraphCommand::NameWires => NodeCommand::ToggleNamedWires.into(),
            GraphCommand::Duplicate => NodeCommand::DuplicateSelected { keeps_inputs: false }.into(),
            GraphCommand::DuplicateWired => NodeCommand::DuplicateSelected { keeps_inputs: true }.into(),
            GraphCommand::Copy if document.selection().is_empty() => {
                return self.shell.notify("Select the nodes to copy first");
            }
            GraphCommand::Copy => ClipboardCommand::Copy.into(),
            GraphCommand::Cut => ClipboardCommand::Cut.into(),
            GraphCommand::Paste => return self.shell.keyboard.request_paste(ui.ctx()),
            GraphCommand::Frame => FrameCommand::Add.into(),
            GraphCommand::Group => GroupCommand::Make.into(),
            GraphCommand::Ungroup => GroupCommand::Dissolve.into(),
            GraphCommand::Enter => match document.selected_one() {
                Some(id) => NavigationCommand::Enter(id.clone()).into(),
                None => return,
            },
            GraphCommand::Leave if self.views.canvas.cancel_drag() => return,
            GraphCommand::Leave => NavigationCommand::Leave.into(),
        };
        self.edit(edit, ui);
    }

    /// Adds a node of a favorite where the pointer is.
    pub(super) fn add_favorite(&mut self, favorite: Favorite, ui: &Ui) {
        let key = self.shell.settings.favorites.get(favorite.index());
        let mut candidates = self.documents.candidates().iter();
        let found = key.and_then(|key| candidates.find(|known| known.is_favorite(key)));
        let Some(new) = found.map(|found| found.new.clone()) else {
            let number = favorite.index() + 1;
            return self.shell.notify(format!(
                "Favorite {number} is empty; click a star in the library to fill it."
            ));
        };
        let place = self.views.canvas.camera.place_for_new(ui);
        self.add_uncovering(new, place, ui);
    }

    /// Adds a node where it is dropped.
    pub(super) fn drop_on(&mut self, target: DropTarget, source: NodeSource, ui: &Ui) {
        match target {
            DropTarget::Mask(node) => self.edit(LayerCommand::AddMask { node, source }, ui),
            DropTarget::Model(place) => {
                let command = LayerCommand::AddOnModel {
                    source,
                    place: place.material,
                    has_normal_map: place.has_normal_map,
                };
                self.edit(command, ui);
            }
            DropTarget::Node(node) => self.edit(LayerCommand::AddOnNode { source, node }, ui),
            DropTarget::Canvas(place, into) => self.add(source, place, into, ui),
        }
    }
}

/// Edit that arranges or selects nodes.
pub(super) fn arrangement(command: ArrangeCommand) -> EditCommand {
    match command {
        ArrangeCommand::AlignLeft => editing::ArrangeCommand::Align(Align::Left).into(),
        ArrangeCommand::AlignRight => editing::ArrangeCommand::Align(Align::Right).into(),
        ArrangeCommand::AlignTop => editing::ArrangeCommand::Align(Align::Top).into(),
        ArrangeCommand::AlignBottom => editing::ArrangeCommand::Align(Align::Bottom).into(),
        ArrangeCommand::DistributeAcross => editing::ArrangeCommand::Distribute(DistributionAxis::Horizontal).into(),
        ArrangeCommand::DistributeDown => editing::ArrangeCommand::Distribute(DistributionAxis::Vertical).into(),
        ArrangeCommand::Straighten => editing::ArrangeCommand::Straighten.into(),
        ArrangeCommand::LayOut => editing::ArrangeCommand::LayOut.into(),
        ArrangeCommand::SelectAll => SelectionCommand::All.into(),
        ArrangeCommand::SelectMuted => SelectionCommand::Muted.into(),
        ArrangeCommand::SelectUp => SelectionCommand::Upstream.into(),
        ArrangeCommand::SelectDown => SelectionCommand::Downstream.into(),
    }
}

/// Returns whether a command looks for free places for its new nodes, rather than adding them where the artist chose.
fn finds_places(command: &EditCommand) -> bool {
    matches!(
        command,
        EditCommand::Layer(_) | EditCommand::Node(NodeCommand::AddTextureSets { .. })
    )
}
