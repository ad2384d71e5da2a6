//! A copy of the shown graph in the canvas crate's types, which is only drawn.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::{Color32, Ui};
use egui_node_graph::{
    DataTypeTrait, InputParamKind, NodeDataTrait, NodeResponse, UserResponseTrait, WidgetValueTrait,
};
use sabi_editing::node_size::{ShownRows, own_knobs};
use sabi_editing::{OpenDocument, exposed_knobs};
use sabi_engine::catalog::Interface;
use sabi_graph::{Body, Edit, NodeId, PortType};

use super::body;
use super::node_summary::{NodeState, NodeSummary, RowContext};
use crate::panels::parameters::mask_of;

/// Graph in the canvas crate's type.
pub(super) type CanvasGraph = egui_node_graph::Graph<NodeSummary, CarriedType, CardRow>;
/// Id of a node in the canvas crate.
pub(super) type CanvasNodeId = egui_node_graph::NodeId;

/// Type that a port carries; `None` for any type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CarriedType(pub(super) Option<PortType>);

/// Row of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum CardRow {
    /// Port, whose dot is drawn by this crate.
    #[default]
    Port,
    /// Parameter, by its index in the catalog entry.
    Knob(usize),
}

/// Response of rows, which the canvas crate requires; rows return their events through their context.
#[derive(Clone, Debug)]
pub(super) struct NoResponse;

impl UserResponseTrait for NoResponse {}

impl DataTypeTrait<RowContext> for CarriedType {
    fn data_type_color(&self, _: &mut RowContext) -> Color32 {
        // The canvas draws the dots itself.
        Color32::TRANSPARENT
    }

    fn name(&self) -> Cow<'_, str> {
        match self.0 {
            Some(ty) => Cow::Owned(ty.to_string()),
            None => Cow::Borrowed("anything"),
        }
    }
}

impl WidgetValueTrait for CardRow {
    type Response = NoResponse;
    type UserState = RowContext;
    type NodeData = NodeSummary;

    fn value_widget(
        &mut self,
        name: &str,
        _: CanvasNodeId,
        ui: &mut Ui,
        row_context: &mut RowContext,
        shown: &NodeSummary,
    ) -> Vec<NoResponse> {
        match self {
            CardRow::Port => body::port_row(ui, row_context, name, true),
            CardRow::Knob(at) => body::knob_row(ui, row_context, shown, *at),
        }
        Vec::new()
    }

    fn value_widget_connected(
        &mut self,
        name: &str,
        key: CanvasNodeId,
        ui: &mut Ui,
        row_context: &mut RowContext,
        shown: &NodeSummary,
    ) -> Vec<NoResponse> {
        self.value_widget(name, key, ui, row_context, shown)
    }
}

impl NodeDataTrait for NodeSummary {
    type Response = NoResponse;
    type UserState = RowContext;
    type DataType = CarriedType;
    type ValueType = CardRow;

    fn top_bar_ui(
        &self,
        ui: &mut Ui,
        _: CanvasNodeId,
        _: &CanvasGraph,
        row_context: &mut RowContext,
    ) -> Vec<NodeResponse<NoResponse, NodeSummary>> {
        body::title_row(ui, row_context, self);
        Vec::new()
    }

    fn output_ui(
        &self,
        ui: &mut Ui,
        _: CanvasNodeId,
        _: &CanvasGraph,
        row_context: &mut RowContext,
        name: &str,
    ) -> Vec<NodeResponse<NoResponse, NodeSummary>> {
        body::port_row(ui, row_context, name, false);
        Vec::new()
    }

    fn bottom_ui(
        &self,
        ui: &mut Ui,
        _: CanvasNodeId,
        _: &CanvasGraph,
        row_context: &mut RowContext,
    ) -> Vec<NodeResponse<NoResponse, NodeSummary>> {
        body::picture_row(ui, row_context, self);
        Vec::new()
    }

    fn can_delete(&self, _: CanvasNodeId, _: &CanvasGraph, _: &mut RowContext) -> bool {
        false
    }

    fn can_flip(&self, _: CanvasNodeId, _: &CanvasGraph, _: &mut RowContext) -> bool {
        false
    }
}

/// Copy of the graph, with the revisions that it was made from.
#[derive(Default)]
pub(super) struct GraphSnapshot {
    pub(super) graph: CanvasGraph,
    keys: BTreeMap<NodeId, CanvasNodeId>,
    /// Shown graph, revision of the document, and number of the ports and knobs of its nodes.
    of: Option<(Body, u64, u64)>,
}

/// Adds the nodes of the shown graph whose values are set by edits to `nodes`. Returns whether the edits change nothing
/// else in the copy.
fn set_only_values<'a>(edits: &'a [Edit], shown: &Body, nodes: &mut BTreeSet<&'a NodeId>) -> bool {
    edits.iter().all(|edit| match edit {
        Edit::Batch(edits) => set_only_values(edits, shown, nodes),
        Edit::SetParam { body, node, .. } if body == shown => {
            nodes.insert(node);
            true
        }
        Edit::Move { .. } => true,
        _ => false,
    })
}

impl GraphSnapshot {
    /// Updates the copy. Unchanged nodes keep their keys, so that a drag continues.
    pub(super) fn sync(&mut self, document: &OpenDocument) {
        let body = document.body();
        let now = (body.clone(), document.session.revision(), document.interfaces_number());
        if self.of.as_ref() == Some(&now) {
            return;
        }
        if self.of.as_ref().is_some_and(|(before, ..)| *before != body) {
            *self = GraphSnapshot::default();
        }
        let is_followed = self.follow_values(document);
        self.of = Some(now);
        if is_followed {
            return;
        }
        let gone: Vec<NodeId> = self
            .keys
            .keys()
            .filter(|id| document.node(id).is_none())
            .cloned()
            .collect();
        for id in gone {
            self.remove(&id);
        }
        for (id, node) in document.graph().nodes() {
            let Some(interface) = document.interface(id) else {
                continue;
            };
            let rows = ShownRows::of(document.graph(), id, interface);
            let is_same = |key: &CanvasNodeId| {
                let known = &self.graph[*key].user_data;
                known.rows == rows && (Arc::ptr_eq(&known.interface, interface) || known.interface == *interface)
            };
            if !self.keys.get(id).is_some_and(is_same) {
                self.remove(id);
                self.add(id, interface.clone(), rows);
            }
            let Some(key) = self.keys.get(id) else { continue };
            let shown = &mut self.graph[*key];
            shown.user_data.title = document.title(id);
            shown.user_data.is_muted = node.muted;
            shown.user_data.values.clone_from(&node.params);
            let knobs = interface.knobs.iter().map(|knob| &knob.name);
            let exposed = knobs
                .filter_map(|knob| Some((knob.clone(), exposed_knobs::exposed_as(document, id, knob)?.to_owned())));
            shown.user_data.exposed = exposed.collect();
            let knobs = interface.knobs.iter().map(|knob| &knob.name);
            let masks = knobs.filter_map(|knob| Some((knob.clone(), mask_of(document, id, knob)?)));
            shown.user_data.masks = masks.collect();
        }
        self.copy_wires(document);
    }

    /// Updates only values, if nothing else has changed, as while a slider moves. Returns whether that was enough.
    fn follow_values(&mut self, document: &OpenDocument) -> bool {
        let known = self
            .of
            .as_ref()
            .filter(|(.., interfaces)| *interfaces == document.interfaces_number());
        let Some(edits) = known.and_then(|(_, revision, _)| document.session.edits_since(*revision)) else {
            return false;
        };
        let mut nodes = BTreeSet::new();
        if !set_only_values(edits, document.shown(), &mut nodes) {
            return false;
        }
        for id in nodes {
            if let Some((key, node)) = self.keys.get(id).zip(document.node(id)) {
                self.graph[*key].user_data.values.clone_from(&node.params);
            }
        }
        true
    }

    pub(super) fn key(&self, id: &NodeId) -> Option<CanvasNodeId> {
        self.keys.get(id).copied()
    }

    fn remove(&mut self, id: &NodeId) {
        if let Some(key) = self.keys.remove(id) {
            self.graph.remove_node(key);
        }
    }

    fn add(&mut self, id: &NodeId, interface: Arc<Interface>, rows: ShownRows) {
        let shown = NodeSummary {
            id: id.clone(),
            interface: interface.clone(),
            rows: rows.clone(),
            title: String::new(),
            is_muted: false,
            state: NodeState::default(),
            is_previewed: false,
            is_pinned: false,
            values: BTreeMap::new(),
            exposed: BTreeMap::new(),
            masks: BTreeMap::new(),
        };
        let key = self.graph.add_node(String::new(), shown, |graph, key| {
            let inputs = interface.inputs.iter().enumerate();
            for (_, port) in inputs.filter(|(row, _)| rows.shows_input(*row)) {
                let carries = CarriedType(port.ty);
                let kind = InputParamKind::ConnectionOnly;
                graph.add_input_param(key, port.label.clone(), carries, CardRow::Port, kind, true);
            }
            for knob in own_knobs(&interface).filter(|_| rows.shows_knobs()) {
                let Some(at) = interface.knobs.iter().position(|known| known.name == knob.name) else {
                    continue;
                };
                let row = CardRow::Knob(at);
                let kind = InputParamKind::ConstantOnly;
                graph.add_input_param(key, knob.label.clone(), CarriedType(None), row, kind, true);
            }
            let outputs = interface.outputs.iter().enumerate();
            for (_, port) in outputs.filter(|(row, _)| rows.shows_output(*row)) {
                graph.add_output_param(key, port.label.clone(), CarriedType(port.ty));
            }
        });
        self.keys.insert(id.clone(), key);
    }

    fn copy_wires(&mut self, document: &OpenDocument) {
        let connected: Vec<_> = self.graph.iter_connections().map(|(input, _)| input).collect();
        for input in connected {
            self.graph.remove_connection(input);
        }
        for id in document.graph().ids() {
            for (name, from) in document.graph().inputs(id.as_str()) {
                let ends = self.keys.get(id).zip(self.keys.get(&from.node));
                let Some((reader, source)) = ends else { continue };
                let [reads, gives] = [reader, source].map(|key| &self.graph[*key].user_data);
                let input = reads.interface.inputs.iter().position(|port| port.name == name);
                let outputs = &gives.interface.outputs;
                let output = match &from.port {
                    Some(port) => outputs.iter().position(|known| known.name == *port),
                    None => (!outputs.is_empty()).then_some(0),
                };
                // Hidden ports have no wires in the copy.
                let input = input.and_then(|input| reads.rows.place_of_input(input));
                let output = output.and_then(|output| gives.rows.place_of_output(output));
                if let Some((input, output)) = input.zip(output) {
                    let (_, input) = self.graph[*reader].inputs[input];
                    let (_, output) = self.graph[*source].outputs[output];
                    self.graph.add_connection(output, input);
                }
            }
        }
    }
}
