//! Layers that are dropped on the model, or on a node on the canvas.

use std::collections::BTreeSet;

use sabi_engine::catalog::Interface;
use sabi_graph::{Body, Document, Edit, NodeId, OutputRef, PortType, SlotRef, Value};
use sabi_nodes::kind::Role;

use crate::node_size::NODE_WIDTH;
use crate::open_document::OpenDocument;
use crate::stack::{StackEnd, main_input};
use crate::{layers, nodes, stack, wires};

/// Kinds of an output, of the model's own material, and of the layer that adds its normal map.
const OUTPUT: &str = "output/material";
const OWN_MATERIAL: &str = "source/model";
pub(crate) const LAYER: &str = "effect/layer";
/// Space between a new output and the nodes before it, canvas points.
const BESIDE: f32 = 60.0;

/// Material of the model at the place where a layer is dropped.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum DroppedOn {
    /// The material of an output of the shown graph.
    Output(StackEnd),
    /// A material with this name, for which no output exists.
    Material(String),
    /// No place of the model was hit, or its output is not in the shown graph.
    #[default]
    Unknown,
}

/// Adds a node of a kind, or an instance of a group, above all layers of the material at a place of the model. If the model
/// has a normal map there that no layer below uses, a layer with the normal map is added, too.
pub(crate) fn on_model(
    document: &mut OpenDocument,
    kind: &str,
    group: Option<&str>,
    place: &DroppedOn,
    has_normal_map: bool,
) -> Option<NodeId> {
    let end = end_at(document, place)?;
    let stack = stack::all(document).into_iter().find(|stack| stack.end == end)?;
    let Some(below) = stack.layers.first().map(|layer| layer.node.clone()) else {
        let id = add(document, &end, 0, kind, group)?;
        let needs = document.interface(&id).and_then(|interface| main_input(interface));
        // A group without a material below uses the model's own material, unless its input says otherwise.
        if needs.is_some_and(|input| group.is_none() || input.is_required) {
            layers::add(document, &end, 1, OWN_MATERIAL)?;
        }
        if has_normal_map && !has_own_material(document, &id) {
            add_normal_map(document, &end)?;
        }
        return Some(id);
    };
    if has_normal_map && !has_own_material(document, &below) {
        add_normal_map(document, &end)?;
    }
    add(document, &end, 0, kind, group)
}

/// Adds a node of a kind, or an instance of a group, on top of the material that a node outputs or that an output receives.
pub(crate) fn on_node(document: &mut OpenDocument, kind: &str, group: Option<&str>, node: &NodeId) -> Option<NodeId> {
    let end = StackEnd::Node(node.clone());
    match stack::all(document).iter().any(|stack| stack.end == end) {
        true => add(document, &end, 0, kind, group),
        false => layers::add_over(document, node, kind, group),
    }
}

/// Returns whether a node or group with these ports can be a layer on top of a node's material.
pub fn can_lie_on(document: &OpenDocument, interface: &Interface, node: &NodeId) -> bool {
    let gives = |interface: &Interface| interface.outputs.iter().any(|port| port.ty == Some(PortType::Material));
    let Some(under) = document.interface(node) else {
        return false;
    };
    let is_output = under.category() == "output" && main_input(under).is_some();
    gives(interface) && main_input(interface).is_some() && (is_output || gives(under))
}

fn add(document: &mut OpenDocument, end: &StackEnd, at: usize, kind: &str, group: Option<&str>) -> Option<NodeId> {
    match group {
        Some(group) => layers::add_instance(document, end, at, group),
        None => layers::add(document, end, at, kind),
    }
}

/// Returns the output of the stack to which a dropped layer is added. An output is added for a material that has none.
fn end_at(document: &mut OpenDocument, place: &DroppedOn) -> Option<StackEnd> {
    let ends: Vec<StackEnd> = stack::all(document).into_iter().map(|stack| stack.end).collect();
    match (place, ends.as_slice()) {
        (DroppedOn::Output(end), _) if ends.contains(end) => Some(end.clone()),
        (DroppedOn::Material(name), _) if *document.shown() == Body::Main => {
            let id = nodes::add(document, OUTPUT, place_of_output(document), None)?;
            // A single output applies to all materials.
            if !ends.is_empty() {
                nodes::set_knob(document, &id, "materials", Some(Value::Text(name.clone())));
            }
            Some(StackEnd::Node(id))
        }
        (_, [end]) => Some(end.clone()),
        (_, []) if *document.shown() == Body::Main => {
            let id = nodes::add(document, OUTPUT, place_of_output(document), None)?;
            Some(StackEnd::Node(id))
        }
        (_, []) => {
            document
                .notify("this group gives no material; add an output to it first, so that there is one to put this on");
            None
        }
        _ => {
            document.notify("there are several outputs; drop it on the place of the model whose material it is for");
            None
        }
    }
}

/// Place for a new output: to the right of all nodes.
fn place_of_output(document: &OpenDocument) -> [f32; 2] {
    let places = document.graph().nodes().map(|(_, node)| node.pos);
    let right = places.reduce(|one, other| if other[0] > one[0] { other } else { one });
    right.map_or([0.0; 2], |[x, y]| [x + 2.0 * (NODE_WIDTH + BESIDE), y])
}

/// Returns whether the result of a node depends on the model's own material, which includes its normal map.
fn has_own_material(document: &OpenDocument, id: &NodeId) -> bool {
    let upstream = document.graph().upstream([id]);
    let mut nodes = upstream.iter().filter_map(|id| document.node(id));
    let is_in_group = |group: &String| is_in_group(document.contents(), group);
    nodes.any(|node| node.kind == OWN_MATERIAL || node.group.as_ref().is_some_and(is_in_group))
}

/// Returns whether a group, or a group inside it, contains a node with the model's own material.
fn is_in_group(document: &Document, group: &str) -> bool {
    let mut seen = BTreeSet::from([group]);
    let mut next = vec![group];
    while let Some(group) = next.pop() {
        let nodes = document
            .groups
            .get(group)
            .into_iter()
            .flat_map(|group| group.graph.nodes());
        for (_, node) in nodes {
            if node.kind == OWN_MATERIAL {
                return true;
            }
            next.extend(node.group.as_deref().filter(|inner| seen.insert(inner)));
        }
    }
    false
}

/// Adds a layer on top that adds the model's normal map and changes nothing else.
fn add_normal_map(document: &mut OpenDocument, end: &StackEnd) -> Option<NodeId> {
    let layer = layers::add(document, end, 0, LAYER)?;
    let interface = document.interface(&layer).cloned()?;
    let body = document.body();
    let switches = interface.knobs.iter().filter(|knob| knob.ty.role == Role::Toggle);
    let mut edits: Vec<Edit> = switches
        .map(|knob| Edit::SetParam {
            body: body.clone(),
            node: layer.clone(),
            param: knob.name.clone(),
            value: Some(Value::Bool(false)),
        })
        .collect();
    edits.push(Edit::SetLabel {
        body,
        node: layer.clone(),
        label: Some("Normal map of the model".to_owned()),
    });
    if !document.edit("Add layer", edits) {
        return None;
    }
    let known = {
        let mut nodes = document.graph().nodes();
        nodes
            .find(|(_, node)| node.kind == OWN_MATERIAL)
            .map(|(id, _)| id.clone())
    };
    let model = match known {
        Some(model) => model,
        None => nodes::add(document, OWN_MATERIAL, layers::place_of_mask(document, &layer), None)?,
    };
    let from = OutputRef {
        node: model,
        port: Some("slope".to_owned()),
    };
    let to = SlotRef {
        node: layer.clone(),
        name: "slope".to_owned(),
    };
    wires::connect(document, &from, &to).then_some(layer)
}
