//! Results that the views show: in the 2D view, on the model, and beside it for comparison.

use std::collections::{BTreeMap, BTreeSet};

use egui::{Context, Key, Modifiers};
use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{OpenDocument, node_paths, painting};
use sabi_engine::catalog::Port;
use sabi_engine::live::ViewSubject;
use sabi_graph::{GROUP_KIND, NodeId, NodeRef, PortType};
use sabi_paint::Version;

use crate::action::LookAction;
use crate::settings::Settings;

/// Purpose of a clicked color.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ColorTarget {
    Parameter(KnobTarget),
    /// Color of the brush.
    Brush,
}

/// Results that the views show.
#[derive(Default)]
pub(crate) struct ShownResults {
    /// Result of the node that was clicked last.
    pub(crate) shown: Option<NodeRef>,
    /// Result that the model shows while it follows clicks; `None` after a click beside all nodes.
    pub(crate) followed: Option<NodeRef>,
    /// Result that the 2D view keeps when another node is clicked.
    pub(crate) pinned_2d: Option<NodeRef>,
    /// Result that the model keeps when another node is clicked.
    pub(crate) pinned_3d: Option<NodeRef>,
    /// Outputs other than the first that were chosen for node pictures, by the full id of the node.
    outputs: BTreeMap<String, String>,
    /// True if the model shows the pinned result beside another result.
    pub(crate) is_compared: bool,
    /// True if the result on the model was pinned by the comparison, and is let go with it.
    is_pinned_to_compare: bool,
    /// Purpose of the next clicked color.
    pub(crate) color_target: Option<ColorTarget>,
    /// Length parameter under the pointer or in a drag, in working units: the viewport draws it as a bar.
    pub(crate) length: Option<f64>,
    /// True if drags on the model paint on the selected paint node.
    pub(crate) is_painting: bool,
    /// Strokes of the painted node that are marked in their list.
    pub(crate) marked_strokes: BTreeSet<Version>,
}

impl ShownResults {
    /// Returns the subject of the model view: the pinned result, or else the followed result, or else the outputs.
    pub(crate) fn on_model(&self, document: &OpenDocument, settings: &Settings) -> ViewSubject {
        // In a comparison the pinned result has its own side.
        let pinned = self.pinned_3d.as_ref().filter(|_| !self.is_compared);
        // A node that a color is chosen for would only offer its own colors.
        let is_color_target = |result: &NodeRef| match &self.color_target {
            Some(ColorTarget::Parameter(KnobTarget::Node { node, .. })) => {
                node_paths::full_id(document, node) == result.node
            }
            // A paint node is a mask most of the time, which has no colors.
            Some(ColorTarget::Brush) => true,
            Some(ColorTarget::Parameter(KnobTarget::Exposed(_))) | None => false,
        };
        let followed = self
            .followed
            .as_ref()
            .filter(|result| settings.follows && !is_color_target(result) && !self.hides_material(document, result));
        pinned
            .or(followed)
            .map_or(ViewSubject::Outputs, |result| ViewSubject::Node(result.clone()))
    }

    /// Returns whether the model shows its material instead of this result of a paint node. While the user paints on a
    /// node that a material reads, the material shows the effect of the strokes; and a node without strokes and without
    /// a base is only black.
    fn hides_material(&self, document: &OpenDocument, result: &NodeRef) -> bool {
        let Some(id) = node_paths::in_shown_graph(document, &result.node) else {
            return false;
        };
        let Some(strokes) = painting::strokes_of(document, &id) else {
            return false;
        };
        let has_base = || document.graph().link_into(id.as_str(), "base").is_some();
        self.is_painting && painting::is_read(document, &id) || strokes.is_empty() && !has_base()
    }

    /// Returns the result that the model is compared with, if any.
    pub(crate) fn beside_model(&self) -> Option<ViewSubject> {
        self.pinned_3d
            .clone()
            .filter(|_| self.is_compared)
            .map(ViewSubject::Node)
    }

    /// Result that the 2D view shows.
    pub(crate) fn inspected(&self) -> Option<&NodeRef> {
        self.pinned_2d.as_ref().or(self.shown.as_ref())
    }

    /// Result of a node: at the output that was chosen last, otherwise at the material output of a group, otherwise at
    /// the first output.
    pub(crate) fn chosen(&self, document: &OpenDocument, id: &NodeId) -> NodeRef {
        let output = self.outputs.get(&node_paths::full_id(document, id)).cloned();
        result_of(document, id, output.or_else(|| material_of_group(document, id)))
    }

    /// Shows a node's result, at an output or at the one that was chosen last.
    pub(crate) fn show(&mut self, document: &OpenDocument, id: &NodeId, output: Option<String>) {
        if let Some(output) = output {
            self.outputs.insert(node_paths::full_id(document, id), output);
        }
        let result = self.chosen(document, id);
        self.followed = Some(result.clone());
        self.shown = Some(result);
    }

    /// Shows the whole material: on the model that of all outputs, and in the 2D view that of the shown graph's output, if it has one.
    pub(crate) fn show_material(&mut self, document: &OpenDocument) {
        self.followed = None;
        let is_output = |id: &&NodeId| document.node(id).is_some_and(|node| node.kind == "output/material");
        if let Some(id) = document.graph().ids().find(is_output) {
            self.shown = Some(self.chosen(document, id));
        }
    }

    /// Shows no result of any node, since another graph is opened.
    pub(crate) fn clear(&mut self) {
        [self.shown, self.followed, self.pinned_2d, self.pinned_3d] = [const { None }; 4];
        self.outputs.clear();
        self.color_target = None;
        self.marked_strokes.clear();
        self.is_painting = false;
    }

    /// Removes results of deleted nodes.
    pub(crate) fn forget_deleted(&mut self, document: &OpenDocument) {
        for result in self.results() {
            result.take_if(|result| !node_paths::exists(document, &result.node));
        }
        self.outputs.retain(|node, _| node_paths::exists(document, node));
    }

    /// Replaces the node with the full id `before` by another one in all shown results.
    pub(crate) fn replace(&mut self, before: &str, by: &NodeRef) {
        for result in self.results() {
            if result.as_ref().is_some_and(|result| result.node == before) {
                *result = Some(by.clone());
            }
        }
    }

    /// Keeps a node's result in the 2D view, or releases it where it is kept.
    pub(crate) fn toggle_pin_2d(&mut self, document: &OpenDocument, id: &NodeId) {
        let result = Some(self.chosen(document, id));
        self.pinned_2d = if self.pinned_2d == result { None } else { result };
    }

    /// Keeps a node's result on the model, or releases it where it is kept.
    pub(crate) fn toggle_pin_3d(&mut self, document: &OpenDocument, id: Option<&NodeId>) {
        let result = id.map(|id| self.chosen(document, id));
        self.pinned_3d = if self.pinned_3d == result { None } else { result };
    }

    /// Begins or ends the choice of a color for a parameter by the next click. Returns whether it has begun.
    pub(crate) fn toggle_color_target(&mut self, target: ColorTarget) -> bool {
        let was_target = self.color_target.take_if(|known| *known == target).is_some();
        if !was_target {
            self.color_target = Some(target);
        }
        !was_target
    }

    /// Ends the choice of a color on Escape, which has no other effect then.
    pub(crate) fn cancel_color_target(&mut self, context: &Context) {
        let is_taking = self.color_target.is_some();
        if is_taking && context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.color_target = None;
        }
    }

    /// Performs an action of a menu.
    pub(crate) fn perform(&mut self, action: LookAction, settings: &mut Settings) {
        match action {
            LookAction::Outputs | LookAction::Follow => {
                settings.follows = action == LookAction::Follow;
                if !self.is_compared {
                    self.pinned_3d = None;
                }
            }
            LookAction::PinIn3d => {
                self.pinned_3d = self.shown.clone();
                self.is_pinned_to_compare = false;
            }
            LookAction::UnpinFrom3d => self.pinned_3d = None,
            LookAction::Compare => {
                self.is_compared = !self.is_compared;
                if self.is_compared && self.pinned_3d.is_none() {
                    self.pinned_3d = self.shown.clone();
                    self.is_pinned_to_compare = true;
                } else if !self.is_compared && std::mem::take(&mut self.is_pinned_to_compare) {
                    self.pinned_3d = None;
                }
            }
            LookAction::UnpinFrom2d => self.pinned_2d = None,
        }
    }

    fn results(&mut self) -> [&mut Option<NodeRef>; 4] {
        [
            &mut self.shown,
            &mut self.followed,
            &mut self.pinned_2d,
            &mut self.pinned_3d,
        ]
    }
}

/// Output of a group that is shown until another one is chosen: its material, which tells more about an effect than the
/// mask of where it is.
fn material_of_group(document: &OpenDocument, id: &NodeId) -> Option<String> {
    document.node(id).filter(|node| node.kind == GROUP_KIND)?;
    material_port(&document.interface(id)?.outputs)
}

/// The first output that gives a material, as results name it: the first output of all has no name.
pub(crate) fn material_port(outputs: &[Port]) -> Option<String> {
    let at = outputs.iter().position(|port| port.ty == Some(PortType::Material))?;
    (at > 0).then(|| outputs[at].name.clone())
}

/// A node's result at an output, as the evaluation names it: the first output has no name.
pub(crate) fn result_of(document: &OpenDocument, id: &NodeId, output: Option<String>) -> NodeRef {
    let outputs = document.interface(id).map_or(&[][..], |interface| &interface.outputs);
    let others = outputs.iter().skip(1).map(|port| &port.name);
    NodeRef {
        node: node_paths::full_id(document, id),
        port: output.filter(|output| others.clone().any(|other| other == output)),
    }
}

/// Title of a node, with the output of a result where it is not the first.
pub(crate) fn title_of(document: &OpenDocument, result: &NodeRef) -> String {
    let title = node_paths::title(document, &result.node);
    match &result.port {
        Some(output) => format!("{title} · {output}"),
        None => title,
    }
}
