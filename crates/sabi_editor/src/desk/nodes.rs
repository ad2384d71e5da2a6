//! Nodes: adding, removing, copying, changing.

use std::collections::{BTreeMap, BTreeSet};

use sabi_engine::catalog::{Entry, KnobRole};
use sabi_graph::{Edit, GROUP_KIND, Graph, Node, NodeId, SlotRef, Value};

use super::{Desk, Loose};

/// How far a copy stands from what it was made of, canvas points.
const COPY_OFFSET: [f32; 2] = [40.0, 40.0];

impl Desk {
    /// A new node of a kind with its id and seeds of its own; it is in no graph yet.
    pub(super) fn fresh(&mut self, kind: &str, pos: [f32; 2]) -> (NodeId, Node) {
        let mut node = Node::new(kind);
        node.pos = pos.map(f32::round);
        let entry = self.catalog.entry(kind).cloned();
        let seeds = entry
            .iter()
            .flat_map(|entry| &entry.knobs)
            .filter(|knob| knob.role == KnobRole::Seed);
        for knob in seeds {
            let seed = Value::Number(f64::from(self.names.seed()));
            node.params.insert(knob.name.clone(), seed);
        }
        let stem = kind.rsplit_once('/').map_or(kind, |(_, name)| name);
        let id = self.new_id(stem, &BTreeSet::new());
        (id, node)
    }

    pub(super) fn new_id(&mut self, stem: &str, taken: &BTreeSet<NodeId>) -> NodeId {
        let body = self.body();
        let graph = self.session.document().body(&body);
        self.names.id(stem, graph.unwrap_or(&Graph::default()), taken)
    }

    pub(super) fn adding(&self, id: &NodeId, node: Node) -> Edit {
        Edit::AddNode {
            body: self.body(),
            id: id.clone(),
            node,
        }
    }

    /// Adds a node of a kind, tied to a loose wire where it fits; selects it.
    pub(crate) fn add(&mut self, kind: &str, pos: [f32; 2], loose: Option<&Loose>) -> Option<NodeId> {
        let Some(entry) = self.catalog.entry(kind).cloned() else {
            self.say(format!("there is no node kind '{kind}'"));
            return None;
        };
        let (id, node) = self.fresh(kind, pos);
        self.place_new(id, node, &entry, loose)
    }

    /// Adds an instance of one of the document's groups.
    pub(crate) fn add_group_instance(&mut self, group: &str, pos: [f32; 2], loose: Option<&Loose>) -> Option<NodeId> {
        let Some(entry) = self.faces.1.of_group(group).cloned() else {
            self.say(format!("there is no group '{group}'"));
            return None;
        };
        let (_, mut node) = self.fresh(GROUP_KIND, pos);
        node.group = Some(group.to_owned());
        let stem = group.to_lowercase().replace(' ', "_");
        let id = self.new_id(&stem, &BTreeSet::new());
        self.place_new(id, node, &entry, loose)
    }

    fn place_new(&mut self, id: NodeId, node: Node, entry: &Entry, loose: Option<&Loose>) -> Option<NodeId> {
        let mut edits = vec![self.adding(&id, node)];
        edits.extend(loose.and_then(|loose| self.tie_loose(loose, &id, entry)));
        let is_made = self.edit(&format!("Add {}", entry.label), edits);
        is_made.then(|| {
            self.select([id.clone()]);
            id
        })
    }

    /// Removes the selected nodes; the wires to those who read them are gone, or heal as if the nodes had been wires.
    pub(crate) fn delete(&mut self, heals: bool) -> bool {
        let ids = self.selection.clone();
        let mut edits = if heals { self.healing(&ids) } else { Vec::new() };
        let body = self.body();
        edits.extend(ids.iter().map(|id| Edit::RemoveNode {
            body: body.clone(),
            id: id.clone(),
        }));
        self.edit(if heals { "Delete and heal" } else { "Delete" }, edits)
    }

    /// Mutes the selected nodes, or lets them speak if all are mute.
    pub(crate) fn mute(&mut self) -> bool {
        let is_muted = |id: &NodeId| self.node(id).is_some_and(|node| node.muted);
        let muted = !self.selection.iter().all(is_muted);
        let body = self.body();
        let edits = self.selection.iter().map(|id| Edit::SetMuted {
            body: body.clone(),
            node: id.clone(),
            muted,
        });
        let edits = edits.collect();
        self.edit(if muted { "Mute" } else { "Unmute" }, edits)
    }

    /// Copies the selected nodes, wires among them included; with `keeps_inputs` also those that come from elsewhere.
    pub(crate) fn duplicate(&mut self, keeps_inputs: bool) -> bool {
        let chosen = self
            .selection
            .iter()
            .filter_map(|id| Some((id.clone(), self.node(id)?.clone())));
        let chosen: BTreeMap<NodeId, Node> = chosen.collect();
        let copies = self.copies(&chosen, keeps_inputs, COPY_OFFSET);
        self.add_all("Duplicate", copies)
    }

    /// Copies under new ids; a copy keeps its seed, so that it looks like what it was made of.
    pub(super) fn copies(
        &mut self,
        nodes: &BTreeMap<NodeId, Node>,
        keeps_inputs: bool,
        offset: [f32; 2],
    ) -> Vec<(NodeId, Node)> {
        let body = self.body();
        let mut taken = BTreeSet::new();
        let mut new_id = BTreeMap::new();
        for id in nodes.keys() {
            let graph = self.session.document().body(&body);
            let copy = self.names.copy_of(id, graph.unwrap_or(&Graph::default()), &taken);
            taken.insert(copy.clone());
            new_id.insert(id, copy);
        }
        let copy = |(id, node): (&NodeId, &Node)| {
            let mut copy = node.clone();
            copy.inputs
                .retain(|_, from| keeps_inputs || nodes.contains_key(&from.node));
            for from in copy.inputs.values_mut() {
                if let Some(new) = new_id.get(&from.node) {
                    from.node = new.clone();
                }
            }
            copy.pos = [0, 1].map(|axis| node.pos[axis] + offset[axis]);
            (new_id[id].clone(), copy)
        };
        nodes.iter().map(copy).collect()
    }

    /// Adds nodes as one step and selects them. They may read each other.
    pub(super) fn add_all(&mut self, step: &str, nodes: Vec<(NodeId, Node)>) -> bool {
        let ids: Vec<NodeId> = nodes.iter().map(|(id, _)| id.clone()).collect();
        let edits = self.adding_all(nodes);
        let is_made = self.edit(step, edits);
        if is_made {
            self.select(ids);
        }
        is_made
    }

    /// The edits that add nodes which read each other: all of them first, then their wires.
    pub(super) fn adding_all(&self, nodes: Vec<(NodeId, Node)>) -> Vec<Edit> {
        let body = self.body();
        let mut wires = Vec::new();
        let mut edits: Vec<Edit> = Vec::new();
        for (id, mut node) in nodes {
            for (input, from) in std::mem::take(&mut node.inputs) {
                wires.push(Edit::Connect {
                    body: body.clone(),
                    node: id.clone(),
                    input,
                    from,
                });
            }
            edits.push(self.adding(&id, node));
        }
        edits.extend(wires);
        edits
    }

    /// Puts a node of another kind in the place of one; wires that fit stay, and so do parameters of the same name.
    pub(crate) fn replace(&mut self, id: &NodeId, kind: &str) -> bool {
        let Some((old, face)) = self.node(id).cloned().zip(self.face(id).cloned()) else {
            return false;
        };
        let Some(entry) = self.catalog.entry(kind).cloned() else {
            return false;
        };
        let (new_id, mut node) = self.fresh(kind, old.pos);
        node.muted = old.muted;
        node.label = old.label.clone();
        for knob in &entry.knobs {
            let same = face.knob(&knob.name).is_some_and(|known| known.role == knob.role);
            if let Some(value) = old.params.get(&knob.name).filter(|_| same) {
                node.params.insert(knob.name.clone(), value.clone());
            }
        }
        let mut free: Vec<_> = entry.inputs.iter().collect();
        for (name, from) in &old.inputs {
            let carried = self.faces.1.carried(&self.body(), from);
            let same = free.iter().position(|port| port.name == *name && port.accepts(carried));
            let fitting = same.or_else(|| free.iter().position(|port| port.ty == carried));
            if let Some(at) = fitting {
                node.inputs.insert(free.remove(at).name.clone(), from.clone());
            }
        }
        let readers = self.graph().readers(id.as_str());
        let mut edits = vec![self.adding(&new_id, node)];
        edits.extend(readers.iter().filter_map(|slot| self.retied(slot, &new_id, &entry)));
        edits.push(Edit::RemoveNode {
            body: self.body(),
            id: id.clone(),
        });
        let is_made = self.edit(&format!("Replace by {}", entry.label), edits);
        if is_made {
            self.select([new_id]);
        }
        is_made
    }

    /// The edit that has a reader read another node instead, by the output of the same name or one that fits.
    fn retied(&self, slot: &SlotRef, id: &NodeId, entry: &Entry) -> Option<Edit> {
        let input = self.input(slot)?;
        let named = self.wire_into(slot)?.port.clone();
        let same = entry.output(named.as_deref()).filter(|port| input.accepts(port.ty));
        let output = same.or_else(|| entry.output_for(input))?;
        let is_first = entry.outputs.first().is_some_and(|first| first.name == output.name);
        Some(Edit::Connect {
            body: self.body(),
            node: slot.node.clone(),
            input: slot.name.clone(),
            from: sabi_graph::OutputRef {
                node: id.clone(),
                port: (!is_first).then(|| output.name.clone()),
            },
        })
    }

    /// Sets a knob of one node, or (`None`) gives it its default back.
    pub(crate) fn set_knob(&mut self, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
        self.set_knob_of([id.clone()], knob, value)
    }

    /// Sets a knob of all selected nodes that are of the same kind as this one, which is among them.
    pub(crate) fn set_knob_of_alike(&mut self, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
        let kind = self.node(id).map(|node| (node.kind.clone(), node.group.clone()));
        let is_alike = |other: &NodeId| self.node(other).map(|node| (node.kind.clone(), node.group.clone())) == kind;
        let mut alike: Vec<NodeId> = self.selection.iter().filter(|other| is_alike(other)).cloned().collect();
        if !alike.contains(id) {
            alike = vec![id.clone()];
        }
        self.set_knob_of(alike, knob, value)
    }

    fn set_knob_of(&mut self, ids: impl IntoIterator<Item = NodeId>, knob: &str, value: Option<Value>) -> bool {
        let body = self.body();
        let edits: Vec<Edit> = ids
            .into_iter()
            .map(|node| Edit::SetParam {
                body: body.clone(),
                node,
                param: knob.to_owned(),
                value: value.clone(),
            })
            .collect();
        let step = format!("Set {}", knob.replace('_', " "));
        self.edit(&step, edits)
    }

    /// Gives a node a name, or its kind's one back.
    pub(crate) fn rename(&mut self, id: &NodeId, name: &str) -> bool {
        let label = Some(name.trim().to_owned()).filter(|name| !name.is_empty());
        let edit = Edit::SetLabel {
            body: self.body(),
            node: id.clone(),
            label,
        };
        self.edit("Rename", vec![edit])
    }
}
