//! From a document to its canonical text: fixed keys in their order, then unknown ones, sorted.

use std::collections::BTreeMap;

use crate::document::{Document, Fit, GroupDef, GroupInput, Preview};
use crate::graph::{Exposed, Frame};
use crate::layout::{Item, Keys};
use crate::migrate::NEWEST;
use crate::{Graph, Node, NodeId, OutputRef, SlotRef, Value};

/// Keys of the file, in order.
const DOCUMENT_KEYS: [&str; 13] = [
    "format", "version", "name", "preview", "fit", "seed", "exposed", "variants", "frames", "groups", "inputs",
    "outputs", "nodes",
];
/// Keys of a group, in order.
const GROUP_KEYS: [&str; 8] = [
    "name", "fit", "exposed", "variants", "frames", "inputs", "outputs", "nodes",
];
/// Keys of a node, in order.
const NODE_KEYS: [&str; 7] = ["kind", "group", "label", "inputs", "params", "pos", "muted"];

impl Document {
    /// The canonical text: the same document gives the same bytes, and reading them gives this document.
    pub fn to_json(&self) -> String {
        let mut keys = Keys::default();
        keys.put("format", "sabi");
        keys.put("version", NEWEST);
        keys.put_some("name", Some(self.name.as_str()).filter(|name| !name.is_empty()));
        if let Some(preview) = &self.preview {
            keys.push("preview".to_owned(), preview_item(preview));
        }
        keys.put_some("fit", Some(self.fit).filter(|fit| *fit != Fit::Unit).map(fit_value));
        keys.put_some("seed", Some(self.seed).filter(|seed| *seed != 0));
        put_panel(&mut keys, &self.graph);
        keys.put_map("groups", &self.groups, group_item);
        put_ports(&mut keys, &self.inputs, &self.outputs);
        put_nodes(&mut keys, &self.graph);
        keys.put_extra(&self.extra, &DOCUMENT_KEYS);
        keys.into_text()
    }
}

fn group_item(group: &GroupDef) -> Item {
    let mut keys = Keys::default();
    keys.put_some("name", group.name.as_deref());
    keys.put_some("fit", group.fit.map(fit_value));
    put_panel(&mut keys, &group.graph);
    put_ports(&mut keys, &group.inputs, &group.outputs);
    put_nodes(&mut keys, &group.graph);
    keys.put_extra(&group.extra, &GROUP_KEYS);
    Item::Keys(keys)
}

fn put_panel(keys: &mut Keys, graph: &Graph) {
    keys.put_map("exposed", &graph.exposed, exposed_item);
    keys.put_map("variants", &graph.variants, |values| {
        Item::Value(Value::Object(values.clone()))
    });
    keys.put_map("frames", &graph.frames, frame_item);
}

fn put_ports(keys: &mut Keys, inputs: &BTreeMap<String, GroupInput>, outputs: &BTreeMap<String, OutputRef>) {
    keys.put_map("inputs", inputs, input_item);
    keys.put_map("outputs", outputs, reference_item);
}

fn put_nodes(keys: &mut Keys, graph: &Graph) {
    let mut nodes = Keys::default();
    for (id, node) in graph.nodes() {
        nodes.push(id.to_string(), node_item(node));
    }
    keys.put_keys("nodes", nodes);
}

fn node_item(node: &Node) -> Item {
    let mut keys = Keys::default();
    keys.put("kind", node.kind.as_str());
    keys.put_some("group", node.group.as_deref());
    keys.put_some("label", node.label.as_deref());
    keys.put_map("inputs", &node.inputs, reference_item);
    keys.put_map("params", &node.params, |value| Item::Value(value.clone()));
    keys.put("pos", node.pos.map(f64::from).to_vec());
    keys.put_some("muted", node.muted.then_some(true));
    keys.put_extra(&node.extra, &NODE_KEYS);
    Item::Keys(keys)
}

fn reference_item(from: &OutputRef) -> Item {
    Item::Value(Value::Text(from.to_string()))
}

fn preview_item(preview: &Preview) -> Item {
    let mut keys = Keys::default();
    keys.put_some("mesh", preview.mesh.as_deref());
    keys.put_some("size", preview.size);
    keys.put_extra(&preview.extra, &["mesh", "size"]);
    Item::Keys(keys)
}

fn exposed_item(knob: &Exposed) -> Item {
    let mut keys = Keys::default();
    keys.put("to", slots(&knob.to));
    keys.put_some("label", knob.label.as_deref());
    keys.put_some("section", knob.section.as_deref());
    keys.put_some("order", knob.order);
    keys.put_some("range", knob.range.map(|ends| ends.to_vec()));
    keys.put_some("default", knob.default.clone());
    keys.put_extra(&knob.extra, &["to", "label", "section", "order", "range", "default"]);
    Item::Keys(keys)
}

fn input_item(input: &GroupInput) -> Item {
    let mut keys = Keys::default();
    keys.put("to", slots(&input.to));
    keys.put_some("type", input.ty.map(|ty| ty.to_string()));
    keys.put_some("label", input.label.as_deref());
    keys.put_extra(&input.extra, &["to", "type", "label"]);
    Item::Keys(keys)
}

fn frame_item(frame: &Frame) -> Item {
    let mut keys = Keys::default();
    keys.put_some("title", frame.title.as_deref());
    keys.put_some("color", frame.color.as_deref());
    keys.put("nodes", frame.nodes.iter().map(NodeId::as_str).collect::<Vec<_>>());
    keys.put_extra(&frame.extra, &["title", "color", "nodes"]);
    Item::Keys(keys)
}

fn slots(slots: &[SlotRef]) -> Vec<String> {
    slots.iter().map(SlotRef::to_string).collect()
}

fn fit_value(fit: Fit) -> Value {
    match fit {
        Fit::Unit => Value::from("unit"),
        Fit::Metres => Value::from("metres"),
        Fit::Length(metres) => Value::Number(metres),
    }
}
