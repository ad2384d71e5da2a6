//! Replacement of a node by a node of another kind.

use std::collections::{BTreeMap, BTreeSet};

use sabi_engine::catalog::{Interface, Knob, Port};
use sabi_graph::{Edit, Node, NodeId, OutputRef, SlotRef, Value};
use sabi_nodes::kind::Role;

use crate::connections::port_in_wire;
use crate::open_document::OpenDocument;
use crate::references::Successors;
use crate::{connections, new_nodes, nodes, references};

/// Node that replaces another node.
struct ReplacementNode<'a> {
    id: &'a NodeId,
    /// Ports and knobs of the old node and of the new node.
    interfaces: [&'a Interface; 2],
    /// Name of the new input for each old input.
    inputs: BTreeMap<String, String>,
}

impl Successors for ReplacementNode<'_> {
    fn knobs(&self, _: &str, knob: &SlotRef) -> Vec<SlotRef> {
        let [old, new] = self.interfaces;
        // A parameter is replaced by a parameter, whether a mask multiplies it or not.
        let is_of_input = old.param_mask(&knob.name).is_none();
        let name = match self.inputs.get(&knob.name).filter(|_| is_of_input) {
            Some(input) => new.knob(input).map(|knob| &knob.name),
            None => new
                .knob(&knob.name)
                .filter(|new| are_alike(old.knob(&knob.name), new))
                .map(|knob| &knob.name),
        };
        name.map(|name| self.slot(name)).into_iter().collect()
    }

    fn inputs(&self, input: &SlotRef) -> Vec<SlotRef> {
        let new = self.inputs.get(&input.name);
        new.map(|name| self.slot(name)).into_iter().collect()
    }

    fn output(&self, from: &OutputRef) -> Option<OutputRef> {
        let [old, new] = self.interfaces;
        let port = old.output(from.port.as_deref())?;
        let same = new
            .outputs
            .iter()
            .find(|other| other.name == port.name && other.ty == port.ty);
        let output = same.or_else(|| new.outputs.iter().find(|other| other.ty == port.ty))?;
        Some(OutputRef {
            node: self.id.clone(),
            port: port_in_wire(new, output),
        })
    }

    fn nodes(&self, _: &NodeId) -> Vec<NodeId> {
        vec![self.id.clone()]
    }
}

impl ReplacementNode<'_> {
    fn slot(&self, name: &str) -> SlotRef {
        SlotRef {
            node: self.id.clone(),
            name: name.to_owned(),
        }
    }
}

/// Returns whether two knobs have the same meaning: the same role and shape in memory, and both or neither belong to an input.
fn are_alike(old: Option<&Knob>, new: &Knob) -> bool {
    let like = |knob: &Knob| (knob.ty.role.clone(), knob.ty.memory, knob.is_of_input);
    old.is_some_and(|old| like(old) == like(new))
}

/// Returns whether a knob accepts the value of another knob: numbers must be in its range, except in stops and curves.
fn accepts(knob: &Knob, value: &Value) -> bool {
    let one = std::slice::from_ref(value);
    let numbers = || value.as_list().unwrap_or(one).iter().filter_map(Value::as_number);
    match (&knob.ty.role, knob.ty.range) {
        (Role::Stops | Role::Curve, _) | (_, None) => true,
        (_, Some([low, high])) => numbers().all(|number| (low..=high).contains(&number)),
    }
}

/// Replaces a node by a node of another kind. Wires that fit are kept, and so are parameters with the same name, their
/// exposed knobs and the frames around the node.
pub fn by_kind(document: &mut OpenDocument, id: &NodeId, kind: &str) -> bool {
    let Some(entry) = document.catalog().entry(kind).cloned() else {
        return document.refuse(format!("there is no node kind '{kind}'"));
    };
    let (new_id, node) = new_nodes::of_kind(document, kind, [0.0; 2]);
    put_in_place(document, id, new_id, node, &entry)
}

/// Replaces a node by an instance of a group. The same things are kept as in [`by_kind`].
pub fn by_group(document: &mut OpenDocument, id: &NodeId, group: &str) -> bool {
    let made = nodes::new_instance(document, group, [0.0; 2]);
    made.is_some_and(|(new_id, node, entry)| put_in_place(document, id, new_id, node, &entry))
}

fn put_in_place(document: &mut OpenDocument, id: &NodeId, new_id: NodeId, mut node: Node, entry: &Interface) -> bool {
    let Some((old, interface)) = document.node(id).cloned().zip(document.interface(id).cloned()) else {
        return document.refuse("the node that should be replaced is gone");
    };
    if entry.id == interface.id && node.group == old.group {
        return document.refuse(format!("this is a node of kind '{}' already", entry.label));
    }
    node.pos = old.pos;
    node.muted = old.muted;
    node.label = old.label.clone();
    let replacement = ReplacementNode {
        id: &new_id,
        interfaces: [&interface, entry],
        inputs: paired_inputs(document, id, &interface, entry),
    };
    let wires = document.graph().inputs(id.as_str()).into_iter();
    let wires = wires.filter_map(|(name, from)| Some((replacement.inputs.get(name)?.clone(), from.clone())));
    let wires = wires.collect();
    for (name, value) in &old.params {
        let slot = SlotRef {
            node: id.clone(),
            name: name.clone(),
        };
        let knobs = replacement.knobs("", &slot).into_iter();
        let accepting = knobs.filter(|slot| entry.knob(&slot.name).is_some_and(|knob| accepts(knob, value)));
        node.params.extend(accepting.map(|slot| (slot.name, value.clone())));
    }
    let readers = document.graph().readers(id.as_str());
    let mut edits = vec![new_nodes::addition(document, &new_id, node, wires)];
    edits.extend(
        readers
            .iter()
            .filter_map(|slot| reconnected(document, slot, &new_id, entry)),
    );
    edits.extend(references::redirecting(
        document,
        &BTreeSet::from([id.clone()]),
        &replacement,
    ));
    edits.push(Edit::RemoveNode {
        body: document.body(),
        id: id.clone(),
    });
    document.edit_and_select(&format!("Replace by {}", entry.label), edits, [new_id])
}

/// Returns the new input for each connected old input: first inputs with the same name, then others that fit. A mask that
/// multiplies a parameter is kept only if a parameter with the same name takes a mask.
fn paired_inputs(
    document: &OpenDocument,
    id: &NodeId,
    interface: &Interface,
    entry: &Interface,
) -> BTreeMap<String, String> {
    let mut free: Vec<&Port> = entry.inputs.iter().collect();
    let mut paired = BTreeMap::new();
    // Inputs are paired in the order of the rows of the node. Inputs that the kind does not have come last.
    let known = interface.inputs.iter().map(|port| &port.name);
    let wires = connections::wires_from(document.graph(), id, |_| true);
    let unknown = wires.keys().filter(|name| interface.input(name).is_none());
    let is_param_mask = |name: &String| interface.param_mask(name).is_some();
    let (param_masks, names): (Vec<&String>, Vec<&String>) = known.chain(unknown).partition(|name| is_param_mask(name));
    let kept = param_masks.into_iter().filter(|name| entry.param_mask(name).is_some());
    paired.extend(kept.map(|name| (name.clone(), name.clone())));
    for is_named in [true, false] {
        for name in &names {
            let carried = match wires.get(*name) {
                Some(from) => connections::carried(document, from),
                None => interface.input(name).and_then(|port| port.ty),
            };
            let slot = SlotRef {
                node: id.clone(),
                name: (*name).clone(),
            };
            let is_used = wires.contains_key(*name) || connections::feeder(document, document.shown(), &slot).is_some();
            if paired.contains_key(*name) || !is_used {
                continue;
            }
            let fitting = match is_named {
                true => free
                    .iter()
                    .position(|port| port.name == **name && port.accepts(carried)),
                false => free.iter().position(|port| port.ty == carried),
            };
            if let Some(at) = fitting {
                paired.insert((*name).clone(), free.remove(at).name.clone());
            }
        }
    }
    paired
}

/// Returns an edit that connects a reader to the new node, to the output with the same name or to one that fits.
fn reconnected(document: &OpenDocument, slot: &SlotRef, id: &NodeId, entry: &Interface) -> Option<Edit> {
    let input = connections::input(document, slot)?;
    let named = connections::wire_into(document, slot)?.port.clone();
    let same = entry.output(named.as_deref()).filter(|port| input.accepts(port.ty));
    let output = same.or_else(|| entry.output_for(input))?;
    Some(Edit::Connect {
        body: document.body(),
        node: slot.node.clone(),
        input: slot.name.clone(),
        from: OutputRef {
            node: id.clone(),
            port: port_in_wire(entry, output),
        },
    })
}
