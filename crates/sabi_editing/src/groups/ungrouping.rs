//! Ungrouping: an instance is replaced by the nodes of its group, with the values that the instance had.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{
    Body, Edit, Fit, GROUP_KIND, GroupDef, INSTANCE_KNOBS, KnobCurve, Node, NodeId, OutputRef, SlotRef, Value,
};
use sabi_nodes::kind::Role;

use crate::names::separate_file_notice;
use crate::open_document::OpenDocument;
use crate::references::Successors;
use crate::{connections, duplication, references};

/// Replaces the selected instances by the nodes of their groups, and removes groups without instances.
pub fn dissolve_selected(document: &mut OpenDocument) -> bool {
    let ids: Vec<NodeId> = document.selection().iter().cloned().collect();
    let (mut inner, mut is_made) = (BTreeSet::new(), false);
    let mut file = None;
    document.session.begin("Ungroup");
    for id in ids {
        let instance = document.node(&id).filter(|node| node.kind == GROUP_KIND).cloned();
        let Some((instance, name)) = instance.and_then(|node| Some((node.clone(), node.group?))) else {
            continue;
        };
        match document.contents().groups.get(&name).cloned() {
            Some(group) => {
                let added = dissolve(document, &id, &instance, &name, &group);
                is_made |= added.is_some();
                inner.extend(added.into_iter().flatten());
            }
            None => file = Some(name),
        }
    }
    document.session.end();
    if !is_made {
        return document.refuse(match file {
            Some(name) => separate_file_notice(&name),
            None => "select a group to ungroup".to_owned(),
        });
    }
    let rest = document.selection().clone();
    document.select(rest.into_iter().chain(inner));
    true
}

/// Replaces one instance. Returns the new nodes; `None` if this was refused.
fn dissolve(
    document: &mut OpenDocument,
    id: &NodeId,
    instance: &Node,
    name: &str,
    group: &GroupDef,
) -> Option<Vec<NodeId>> {
    let inner: BTreeMap<NodeId, Node> = group
        .graph
        .nodes()
        .map(|(id, node)| (id.clone(), node.clone()))
        .collect();
    let corner = inner.values().fold([f32::INFINITY; 2], |corner, node| {
        [corner[0].min(node.pos[0]), corner[1].min(node.pos[1])]
    });
    let offset = match inner.is_empty() {
        true => [0.0; 2],
        false => [0, 1].map(|axis| instance.pos[axis] - corner[axis]),
    };
    let wires = duplication::wires_between(&group.graph, &inner, false);
    let mut copies = duplication::copies(document, &inner, wires, group.graph.frames().clone(), offset);
    let dissolved = DissolvedGroup {
        group,
        new_id: copies.new_id.clone(),
    };
    for (_, node) in &mut copies.nodes {
        node.muted |= instance.muted;
    }
    dissolved.set_knobs(instance, &mut copies.nodes);
    scale_lengths(document, instance, name, &dissolved, &mut copies.nodes);
    let ids = copies.ids();
    let mut edits = duplication::additions(document, copies);
    edits.extend(rewired(document, id, &dissolved));
    edits.extend(references::redirecting(
        document,
        &BTreeSet::from([id.clone()]),
        &dissolved,
    ));
    edits.push(Edit::RemoveNode {
        body: document.body(),
        id: id.clone(),
    });
    if !document.edit("Ungroup", edits) {
        return None;
    }
    notify_differences(document, instance, name, group);
    // Refused without a notice if the group has other instances.
    document.edit_quietly("Ungroup", Edit::RemoveGroup { name: name.to_owned() });
    Some(ids)
}

/// Returns edits that move the wires of an instance to the nodes that replace it.
fn rewired(document: &OpenDocument, id: &NodeId, dissolved: &DissolvedGroup<'_>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (name, from) in document.graph().inputs(id.as_str()) {
        let slot = SlotRef {
            node: id.clone(),
            name: name.to_owned(),
        };
        edits.extend(dissolved.inputs(&slot).into_iter().map(|slot| Edit::Connect {
            body: document.body(),
            node: slot.node,
            input: slot.name,
            from: from.clone(),
        }));
    }
    for slot in document.graph().readers(id.as_str()) {
        let from = connections::wire_into(document, &slot).and_then(|from| dissolved.output(from));
        edits.extend(from.map(|from| Edit::Connect {
            body: document.body(),
            node: slot.node,
            input: slot.name,
            from,
        }));
    }
    edits
}

/// Multiplies the lengths of the new nodes by the instance's Scale.
fn scale_lengths(
    document: &OpenDocument,
    instance: &Node,
    name: &str,
    dissolved: &DissolvedGroup<'_>,
    nodes: &mut [(NodeId, Node)],
) {
    let scale = instance.params.get("scale").and_then(Value::as_number).unwrap_or(1.0);
    if scale == 1.0 {
        return;
    }
    let body = Body::Group(name.to_owned());
    for (old, new) in &dissolved.new_id {
        let Some(((_, node), interface)) = nodes
            .iter_mut()
            .find(|(id, _)| id == new)
            .zip(document.interfaces().of(&body, old.as_str()))
        else {
            continue;
        };
        if node.kind == GROUP_KIND {
            let own = node.params.get("scale").and_then(Value::as_number).unwrap_or(1.0);
            node.params.insert("scale".to_owned(), Value::Number(own * scale));
            continue;
        }
        for knob in interface.knobs.iter().filter(|knob| knob.ty.role == Role::Length) {
            let value = node.params.get(&knob.name).unwrap_or(&knob.ty.default);
            let value = scaled(value, scale);
            node.params.insert(knob.name.clone(), value);
        }
    }
}

/// Adds notices about properties of the instance that are lost.
fn notify_differences(document: &mut OpenDocument, instance: &Node, name: &str, group: &GroupDef) {
    let title = instance.label.clone().unwrap_or_else(|| name.to_owned());
    if instance
        .params
        .get("seed")
        .and_then(Value::as_number)
        .is_some_and(|seed| seed != 0.0)
    {
        document.notify(format!(
            "'{title}' had a Seed of its own, without which its patterns are others"
        ));
    }
    let outer = match document.shown() {
        Body::Main => None,
        Body::Group(open) => document.contents().groups.get(open).and_then(|group| group.fit),
    };
    let outer: Fit = outer.unwrap_or(document.contents().fit);
    if group.fit.is_some_and(|fit| fit != outer) {
        document.notify(format!(
            "'{title}' was made for models of another size; look at its lengths"
        ));
    }
}

fn scaled(value: &Value, scale: f64) -> Value {
    match value {
        Value::Number(length) => Value::Number(length * scale),
        Value::List(lengths) => Value::List(lengths.iter().map(|length| scaled(length, scale)).collect()),
        other => other.clone(),
    }
}

/// Contents of a dissolved group, with the new ids of its nodes.
struct DissolvedGroup<'a> {
    group: &'a GroupDef,
    new_id: BTreeMap<NodeId, NodeId>,
}

impl DissolvedGroup<'_> {
    fn moved(&self, slots: &[SlotRef]) -> Vec<SlotRef> {
        let moved = |slot: &SlotRef| {
            Some(SlotRef {
                node: self.new_id.get(&slot.node)?.clone(),
                name: slot.name.clone(),
            })
        };
        slots.iter().filter_map(moved).collect()
    }

    /// Sets the values that exposed knobs give to nodes: defaults first, then the instance's variant, then its own values.
    fn set_knobs(&self, instance: &Node, nodes: &mut [(NodeId, Node)]) {
        let exposed = self.group.graph.exposed();
        let defaults = exposed
            .iter()
            .filter_map(|(name, knob)| Some((name, knob.default.as_ref()?)));
        let variant = instance.params.get("variant").and_then(Value::as_text);
        let variant = variant.and_then(|name| self.group.graph.variants().get(name));
        let own = instance
            .params
            .iter()
            .filter(|(name, _)| !INSTANCE_KNOBS.contains(&name.as_str()));
        for (name, value) in defaults.chain(variant.into_iter().flatten()).chain(own) {
            let Some(knob) = exposed.get(name) else { continue };
            for (slot, value) in knob.settings(value) {
                let moved = self.new_id.get(&slot.node);
                if let Some((_, node)) = nodes.iter_mut().find(|(id, _)| Some(id) == moved) {
                    node.params.insert(slot.name.clone(), value);
                }
            }
        }
    }
}

impl Successors for DissolvedGroup<'_> {
    fn knobs(&self, _: &str, knob: &SlotRef) -> Vec<SlotRef> {
        let exposed = self.group.graph.exposed().get(&knob.name);
        exposed.map_or_else(Vec::new, |knob| self.moved(&knob.to))
    }

    fn curve(&self, before: Option<&KnobCurve>, removed: &SlotRef, successor: &SlotRef) -> Option<KnobCurve> {
        let inside = self.group.graph.exposed().get(&removed.name)?.curves.iter();
        let moved =
            |slot: &SlotRef| self.new_id.get(&slot.node) == Some(&successor.node) && slot.name == successor.name;
        let inner = inside.into_iter().find(|(slot, _)| moved(slot)).map(|(_, curve)| curve);
        match (before, inner) {
            (Some(before), Some(inner)) => Some(before.then(inner)),
            (before, inner) => before.or(inner).cloned(),
        }
    }

    fn inputs(&self, input: &SlotRef) -> Vec<SlotRef> {
        let input = self.group.inputs.get(&input.name);
        input.map_or_else(Vec::new, |input| self.moved(&input.to))
    }

    fn output(&self, from: &OutputRef) -> Option<OutputRef> {
        // A wire that names no output means the only output.
        let first = self.group.outputs.keys().next();
        let inner = self.group.outputs.get(from.port.as_ref().or(first)?)?;
        Some(OutputRef {
            node: self.new_id.get(&inner.node)?.clone(),
            port: inner.port.clone(),
        })
    }

    fn nodes(&self, _: &NodeId) -> Vec<NodeId> {
        self.new_id.values().cloned().collect()
    }
}
