//! Nodes: adding, removing, copying, changing.

use std::collections::BTreeSet;
use std::sync::Arc;

use sabi_engine::catalog::{Entry, Faces, KnobRole};
use sabi_graph::{Body, Edit, GROUP_KIND, Graph, Node, NodeId, Value};

use super::variants::NO_VARIANT;
use super::{GRID, OpenDocument, PendingWire};

/// How names of groups end that are files.
const FILE_ENDING: &str = ".sabi";

/// Whether a group of that name is a file, unless the document has one of that name.
pub(super) fn is_file(group: &str) -> bool {
    group.ends_with(FILE_ENDING)
}

impl OpenDocument {
    /// A new node of a kind with its id and seeds of its own; it is in no graph yet.
    pub(super) fn fresh(&mut self, kind: &str, pos: [f32; 2]) -> (NodeId, Node) {
        let mut node = Node::new(kind);
        node.pos = pos.map(f32::round);
        let entry = self.catalog.entry(kind).cloned();
        let seeds = entry
            .iter()
            .flat_map(|entry| &entry.knobs)
            .filter(|knob| knob.ty.role == KnobRole::Seed);
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
    pub fn add(&mut self, kind: &str, pos: [f32; 2], loose: Option<&PendingWire>) -> Option<NodeId> {
        let Some(entry) = self.catalog.entry(kind).cloned() else {
            self.say(format!("there is no node kind '{kind}'"));
            return None;
        };
        let (id, node) = self.fresh(kind, pos);
        self.place_new(id, node, &entry, loose)
    }

    /// Adds an instance of a group: one of the document's own, or a graph file by its path relative to this one.
    pub fn add_group_instance(&mut self, group: &str, pos: [f32; 2], loose: Option<&PendingWire>) -> Option<NodeId> {
        let (id, node, entry) = self.new_instance(group, pos)?;
        self.place_new(id, node, &entry, loose)
    }

    /// An instance of a group that can be added here, under a free id; says why where there can be none.
    pub(super) fn new_instance(&mut self, group: &str, pos: [f32; 2]) -> Option<(NodeId, Node, Arc<Entry>)> {
        if let Some(open) = self.would_hold_itself(group) {
            self.say(format!(
                "'{group}' holds '{open}', which is open here; a group cannot be inside itself"
            ));
            return None;
        }
        let Some(entry) = self.group_entry(group) else {
            self.say(match is_file(group) {
                true => format!("'{group}' cannot be read; choose a graph file"),
                false => format!("there is no group '{group}'"),
            });
            return None;
        };
        let (_, mut node) = self.fresh(GROUP_KIND, pos);
        node.group = Some(group.to_owned());
        let name = group.rsplit('/').next().unwrap_or(group);
        let stem = name
            .strip_suffix(FILE_ENDING)
            .unwrap_or(name)
            .to_lowercase()
            .replace([' ', '-'], "_");
        let id = self.new_id(&stem, &BTreeSet::new());
        Some((id, node, entry))
    }

    /// What an instance of a group shows, whether there is one or not.
    fn group_entry(&mut self, group: &str) -> Option<Arc<Entry>> {
        if let Some(known) = self.faces.1.of_group(group) {
            return Some(known.clone());
        }
        if !is_file(group) {
            return None;
        }
        let base = self.session.graph().base();
        let files = &mut self.group_files;
        let document = files.read(&base.resolve(group))?;
        let base = base.base_of(group);
        let mut read = |name: &str| files.read(&base.resolve(name));
        Faces::new(&self.catalog, &document, &mut read).of_whole().cloned()
    }

    /// The group that is seen, if instances of another one inside it would hold it in turn.
    pub(super) fn would_hold_itself(&self, group: &str) -> Option<String> {
        let Body::Group(open) = &self.seen else { return None };
        let mut seen = BTreeSet::from([group]);
        let mut next = vec![group];
        while let Some(name) = next.pop() {
            if name == open {
                return Some(open.clone());
            }
            let inner = self
                .contents()
                .groups
                .get(name)
                .into_iter()
                .flat_map(|group| group.graph.nodes());
            let held = inner.filter_map(|(_, node)| node.group.as_deref().filter(|_| node.kind == GROUP_KIND));
            next.extend(held.filter(|held| seen.insert(held)));
        }
        None
    }

    fn place_new(&mut self, id: NodeId, mut node: Node, entry: &Entry, loose: Option<&PendingWire>) -> Option<NodeId> {
        node.pos = self.free_place(node.pos);
        let mut edits = vec![self.adding(&id, node)];
        edits.extend(loose.and_then(|loose| self.tie_loose(loose, &id, entry)));
        let is_made = self.edit(&format!("Add {}", entry.label), edits);
        is_made.then(|| {
            self.select([id.clone()]);
            id
        })
    }

    /// A place where no node stands exactly, at the given one or down to the right of it: one node would hide the other.
    fn free_place(&self, pos: [f32; 2]) -> [f32; 2] {
        let is_taken = |place: [f32; 2]| self.graph().nodes().any(|(_, node)| node.pos == place);
        // As many places as there are nodes cannot all be taken, unless it is so far out that a step makes no difference.
        let steps = 0..=self.graph().len();
        let mut places = steps.map(|step| pos.map(|at| at + step as f32 * 2.0 * GRID));
        places.find(|place| !is_taken(*place)).unwrap_or(pos)
    }

    /// Removes the selected nodes; the wires to those who read them are gone, or heal as if the nodes had been wires.
    pub fn delete(&mut self, heals: bool) -> bool {
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
    pub fn mute(&mut self) -> bool {
        let is_muted = |id: &NodeId| self.node(id).is_some_and(|node| node.muted);
        let muted = !self.selection.iter().all(is_muted);
        self.set_muted(self.selection.clone(), muted)
    }

    /// Mutes nodes, or lets them speak.
    pub(super) fn set_muted(&mut self, ids: impl IntoIterator<Item = NodeId>, muted: bool) -> bool {
        let body = self.body();
        let edits = ids.into_iter().map(|node| Edit::SetMuted {
            body: body.clone(),
            node,
            muted,
        });
        let edits = edits.collect();
        self.edit(if muted { "Mute" } else { "Unmute" }, edits)
    }

    /// Sets a knob of one node, or (`None`) gives it its default back.
    pub fn set_knob(&mut self, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
        self.set_knob_of([id.clone()], knob, value)
    }

    /// Sets a knob of all selected nodes that are of the same kind as this one, which is among them.
    pub fn set_knob_of_alike(&mut self, id: &NodeId, knob: &str, value: Option<Value>) -> bool {
        let kind = self.node(id).map(|node| (node.kind.clone(), node.group.clone()));
        let is_alike = |other: &NodeId| self.node(other).map(|node| (node.kind.clone(), node.group.clone())) == kind;
        let mut alike: Vec<NodeId> = self.selection.iter().filter(|other| is_alike(other)).cloned().collect();
        if !alike.contains(id) {
            alike = vec![id.clone()];
        }
        self.set_knob_of(alike, knob, value)
    }

    fn set_knob_of(&mut self, ids: impl IntoIterator<Item = NodeId>, knob: &str, value: Option<Value>) -> bool {
        let mut edits = Vec::new();
        for node in ids {
            let value = value.clone().filter(|value| !self.means_no_variant(&node, knob, value));
            edits.extend(self.published_default(&node, knob, value.as_ref()));
            edits.push(Edit::SetParam {
                body: self.body(),
                node,
                param: knob.to_owned(),
                value,
            });
        }
        let step = format!("Set {}", knob.replace('_', " "));
        self.edit(&step, edits)
    }

    /// Whether a value says that an instance starts from no variant of its group, for which a file has no word.
    fn means_no_variant(&self, id: &NodeId, knob: &str, value: &Value) -> bool {
        let is_instance = self.node(id).is_some_and(|node| node.kind == GROUP_KIND);
        is_instance && knob == "variant" && value.as_text() == Some(NO_VARIANT)
    }

    /// Gives a node a name, or its kind's one back.
    pub fn rename(&mut self, id: &NodeId, name: &str) -> bool {
        let label = Some(name.trim().to_owned()).filter(|name| !name.is_empty());
        let edit = Edit::SetLabel {
            body: self.body(),
            node: id.clone(),
            label,
        };
        self.edit("Rename", vec![edit])
    }
}
