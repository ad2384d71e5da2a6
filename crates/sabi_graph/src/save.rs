//! Conversion of a document to its canonical text: fixed keys in their order, then unknown keys, sorted.

use std::collections::BTreeMap;

use crate::document::{Description, Document, Fit, GroupDef, GroupInput, LibrarySource, Preview, SavedView};
use crate::format;
use crate::graph::{ExposedParameter, Frame};
use crate::layout::{LayoutItem, OrderedObject};
use crate::migrate::NEWEST;
use crate::{Graph, KnobCurve, Node, NodeId, NodeRows, Note, OutputRef, SlotRef, Value};

impl Document {
    /// Returns the canonical text. Equal documents give the same bytes, and reading them gives an equal document.
    pub fn to_json(&self) -> String {
        let mut object = OrderedObject::default();
        object.put("format", "sabi");
        object.put("version", NEWEST);
        object.put_some("name", Some(self.name.as_str()).filter(|name| !name.is_empty()));
        put_description(&mut object, &self.description);
        if let Some(preview) = &self.preview {
            object.push("preview".to_owned(), preview_item(preview));
        }
        object.put_some("fit", Some(self.fit).filter(|fit| *fit != Fit::Unit).map(fit_value));
        object.put_some("seed", Some(self.seed).filter(|seed| *seed != 0));
        put_exposed(&mut object, &self.graph);
        object.put_map("groups", &self.groups, group_item);
        put_ports(&mut object, &self.inputs, &self.outputs);
        put_nodes(&mut object, &self.graph);
        object.put_extra(&self.extra, |key| format::DOCUMENT.has(key));
        object.into_text()
    }
}

fn group_item(group: &GroupDef) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put_some("name", group.name.as_deref());
    put_description(&mut object, &group.description);
    if let Some(library) = &group.library {
        object.push("library".to_owned(), library_item(library));
    }
    object.put_some("fit", group.fit.map(fit_value));
    put_exposed(&mut object, &group.graph);
    put_ports(&mut object, &group.inputs, &group.outputs);
    put_nodes(&mut object, &group.graph);
    object.put_extra(&group.extra, |key| format::GROUP.has(key));
    LayoutItem::Object(object)
}

fn put_description(object: &mut OrderedObject, description: &Description) {
    object.put_some("about", description.about.as_deref());
    put_texts(object, "words", &description.words);
}

/// Adds a list of texts, unless it is empty.
fn put_texts(object: &mut OrderedObject, key: &str, texts: &[String]) {
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    object.put_some(key, Some(texts).filter(|texts| !texts.is_empty()));
}

fn library_item(library: &LibrarySource) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("file", library.file.as_str());
    object.put("digest", library.digest.as_str());
    object.put_extra(&library.extra, |key| format::LIBRARY.has(key));
    LayoutItem::Object(object)
}

fn put_exposed(object: &mut OrderedObject, graph: &Graph) {
    object.put_map("exposed", &graph.exposed, exposed_item);
    object.put_map("variants", &graph.variants, |values| {
        LayoutItem::Value(Value::Object(values.clone()))
    });
    object.put_map("frames", &graph.frames, frame_item);
    object.put_map("notes", &graph.notes, note_item);
}

fn put_ports(object: &mut OrderedObject, inputs: &BTreeMap<String, GroupInput>, outputs: &BTreeMap<String, OutputRef>) {
    object.put_map("inputs", inputs, input_item);
    object.put_map("outputs", outputs, reference_item);
}

fn put_nodes(object: &mut OrderedObject, graph: &Graph) {
    let mut nodes = OrderedObject::default();
    for (id, node) in graph.nodes() {
        nodes.push(id.to_string(), node_item(node, &graph.inputs(id.as_str())));
    }
    object.put_object("nodes", nodes);
}

fn node_item(node: &Node, inputs: &BTreeMap<&str, &OutputRef>) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("kind", node.kind.as_str());
    object.put_some("group", node.group.as_deref());
    object.put_some("label", node.label.as_deref());
    object.put_map("inputs", inputs, |from| reference_item(from));
    object.put_map("params", &node.params, |value| LayoutItem::Value(value.clone()));
    object.put("pos", node.pos.map(f64::from).to_vec());
    object.put_some("muted", node.muted.then_some(true));
    let rows = NodeRows::NAMES.iter().find(|(rows, _)| *rows == node.display.rows);
    let rows = rows.filter(|(rows, _)| *rows != NodeRows::All);
    object.put_some("rows", rows.map(|(_, name)| *name));
    object.put_some("named_wires", node.display.has_named_wires.then_some(true));
    object.put_extra(&node.extra, |key| format::NODE.has(key));
    LayoutItem::Object(object)
}

fn reference_item(from: &OutputRef) -> LayoutItem {
    LayoutItem::Value(Value::Text(from.to_string()))
}

fn preview_item(preview: &Preview) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put_some("mesh", preview.mesh.as_deref());
    object.put_some("textures", preview.textures.as_deref());
    put_texts(&mut object, "parts", &preview.parts);
    put_texts(&mut object, "without", &preview.without);
    object.put_some("turn_faces", preview.turn_faces.then_some(true));
    object.put_some("size", preview.size);
    object.put_some("variant", preview.variant.as_deref());
    object.put_map("views", &preview.views, view_item);
    object.put_extra(&preview.extra, |key| format::PREVIEW.has(key));
    LayoutItem::Object(object)
}

fn view_item(view: &SavedView) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("target", view.target.to_vec());
    object.put("yaw", view.yaw);
    object.put("pitch", view.pitch);
    object.put("distance", view.distance);
    object.put_some("parallel", view.is_parallel.then_some(true));
    object.put_extra(&view.extra, |key| format::VIEW.has(key));
    LayoutItem::Object(object)
}

fn exposed_item(knob: &ExposedParameter) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("to", slots(&knob.to));
    object.put_map("curves", &knob.curves, curve_item);
    object.put_some("label", knob.label.as_deref());
    object.put_some("about", knob.about.as_deref());
    object.put_some("section", knob.section.as_deref());
    object.put_some("order", knob.order);
    object.put_some("range", knob.range.map(|ends| ends.to_vec()));
    object.put_some("default", knob.default.clone());
    object.put_extra(&knob.extra, |key| format::EXPOSED.has(key));
    LayoutItem::Object(object)
}

fn curve_item(curve: &KnobCurve) -> LayoutItem {
    let points = curve
        .points()
        .iter()
        .map(|point| Value::List(point.map(Value::Number).to_vec()));
    LayoutItem::Value(Value::List(points.collect()))
}

fn input_item(input: &GroupInput) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("to", slots(&input.to));
    object.put_some("type", input.ty.map(|ty| ty.to_string()));
    object.put_some("label", input.label.as_deref());
    object.put_extra(&input.extra, |key| format::INPUT.has(key));
    LayoutItem::Object(object)
}

fn frame_item(frame: &Frame) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put_some("title", frame.title.as_deref());
    object.put_some("color", frame.color.as_deref());
    object.put("nodes", frame.nodes.iter().map(NodeId::as_str).collect::<Vec<_>>());
    object.put_extra(&frame.extra, |key| format::FRAME.has(key));
    LayoutItem::Object(object)
}

fn note_item(note: &Note) -> LayoutItem {
    let mut object = OrderedObject::default();
    object.put("text", note.text.as_str());
    object.put("pos", note.pos.map(f64::from).to_vec());
    object.put("width", f64::from(note.width));
    object.put_some("color", note.color.as_deref());
    object.put_extra(&note.extra, |key| format::NOTE.has(key));
    LayoutItem::Object(object)
}

fn slots(slots: &[SlotRef]) -> Vec<String> {
    slots.iter().map(SlotRef::to_string).collect()
}

fn fit_value(fit: Fit) -> Value {
    match fit {
        Fit::Unit => Value::from("unit"),
        Fit::Metres => Value::from("metres"),
        Fit::Piece => Value::from("piece"),
        Fit::Length(metres) => Value::Number(metres),
    }
}
