//! A group out of nodes: the graph gives what it gave, and the panel, the group's inputs and outputs and the frames turn to the
//! instance.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{
    Body, Edit, Exposed, GROUP_KIND, GroupDef, GroupInput, INSTANCE_KNOBS, Node, NodeId, OutputRef, SlotRef,
};

use crate::duplication::frames_around;
use crate::names::free_name;
use crate::open_document::OpenDocument;
use crate::references::Heir;
use crate::{connections, groups, instances, new_nodes, references};

/// Makes a group of the selected nodes and puts an instance in their place.
pub fn make(document: &mut OpenDocument) -> bool {
    let ids = document.selection().clone();
    if ids.is_empty() {
        return document.refuse("select the nodes that a group should hold");
    }
    let mut faces = ids.iter().filter_map(|id| document.face(id));
    if faces.any(|face| face.category() == "output") {
        return document.refuse("an output cannot be inside a group; leave it outside and group what leads to it");
    }
    if let Some(between) = first_between(document, &ids) {
        let title = document.title(&between);
        return document.refuse(format!("'{title}' lies between the selected nodes; select it too"));
    }
    let name = groups::free_name_for(document, "Group");
    let instance = document.new_id("group", &BTreeSet::new());
    let border = Border::around(document, &ids, &instance);
    let mut edits = definition(document, &name, &ids, &border);
    edits.extend(instance_edits(document, &name, &ids, &border));
    document.edit_and_select("Group", edits, [instance])
}

/// A node outside that is made from nodes inside and that nodes inside are made from: a group would lead in a circle.
fn first_between(document: &OpenDocument, ids: &BTreeSet<NodeId>) -> Option<NodeId> {
    let reached = |is_upstream: bool| {
        let mut seen = BTreeSet::new();
        let mut next: Vec<NodeId> = ids.iter().cloned().collect();
        while let Some(id) = next.pop() {
            for neighbor in connections::neighbors(document, &id, is_upstream) {
                if seen.insert(neighbor.clone()) {
                    next.push(neighbor);
                }
            }
        }
        seen
    };
    let (above, below) = (reached(true), reached(false));
    above.intersection(&below).find(|id| !ids.contains(*id)).cloned()
}

/// The edits that define a group of the nodes.
fn definition(document: &OpenDocument, name: &str, ids: &BTreeSet<NodeId>, border: &Border) -> Vec<Edit> {
    let body = || Body::Group(name.to_owned());
    let fit = match document.shown() {
        Body::Main => None,
        // Lengths inside mean what they meant.
        Body::Group(open) => document.contents().groups.get(open).and_then(|group| group.fit),
    };
    let group = Box::new(GroupDef {
        fit,
        ..GroupDef::default()
    });
    let mut edits = vec![Edit::AddGroup {
        name: name.to_owned(),
        group,
    }];
    let order = document.graph().topological_order();
    for id in order.into_iter().filter(|id| ids.contains(id)) {
        let Some(mut node) = document.node(&id).cloned() else {
            continue;
        };
        node.inputs.retain(|_, from| ids.contains(&from.node));
        edits.push(Edit::AddNode { body: body(), id, node });
    }
    edits.extend(border.inputs.iter().map(|(name, input)| Edit::SetInput {
        body: body(),
        name: name.clone(),
        input: Some(GroupInput {
            to: input.slots.clone(),
            ..GroupInput::default()
        }),
    }));
    edits.extend(border.outputs.iter().map(|(name, from)| Edit::SetOutput {
        body: body(),
        name: name.clone(),
        output: Some(from.clone()),
    }));
    edits.extend(border.knobs.iter().map(|(name, knob)| Edit::Expose {
        body: body(),
        name: name.clone(),
        knob: knob.clone(),
    }));
    let frames = frames_around(document.graph(), |id| ids.contains(id));
    edits.extend(frames.into_iter().map(|(id, frame)| Edit::AddFrame {
        body: body(),
        id,
        frame,
    }));
    edits
}

/// The edits that put an instance in the place of the nodes.
fn instance_edits(document: &OpenDocument, name: &str, ids: &BTreeSet<NodeId>, border: &Border) -> Vec<Edit> {
    let mut node = Node::new(GROUP_KIND);
    node.group = Some(name.to_owned());
    let places = ids.iter().filter_map(|id| Some(document.node(id)?.pos));
    let sum = places.fold([0.0; 2], |sum, pos| [sum[0] + pos[0], sum[1] + pos[1]]);
    node.pos = sum.map(|sum| (sum / ids.len() as f32).round());
    let wired = border.inputs.iter();
    let wired = wired.filter_map(|(name, input)| Some((name.clone(), input.from.clone()?)));
    node.inputs = wired.collect();
    let mut edits = vec![new_nodes::addition(document, &border.instance, node)];
    for id in ids {
        let readers = document.graph().readers(id.as_str()).into_iter();
        for slot in readers.filter(|slot| !ids.contains(&slot.node)) {
            let from = connections::wire_into(document, &slot).and_then(|from| border.output(from));
            edits.extend(from.map(|from| Edit::Connect {
                body: document.body(),
                node: slot.node,
                input: slot.name,
                from,
            }));
        }
    }
    edits.extend(references::handed_over(document, ids, border));
    // Those that held nothing else went into the group.
    let frames = frames_around(document.graph(), |id| ids.contains(id));
    edits.extend(frames.into_keys().map(|id| Edit::RemoveFrame {
        body: document.body(),
        id,
    }));
    edits.extend(ids.iter().map(|id| Edit::RemoveNode {
        body: document.body(),
        id: id.clone(),
    }));
    edits
}

/// What leads into some nodes, out of them and to their knobs, by the names that a group has for it.
struct Border {
    instance: NodeId,
    inputs: BTreeMap<String, Entrance>,
    /// Inside the group.
    outputs: BTreeMap<String, OutputRef>,
    /// The output for each way to write where a wire comes from.
    given: BTreeMap<OutputRef, String>,
    /// Inside the group.
    knobs: BTreeMap<String, Exposed>,
    /// The group's knob for each one on the panel outside.
    turned: BTreeMap<String, String>,
}

/// What several inputs inside have in common.
struct Entrance {
    /// The wire from outside.
    from: Option<OutputRef>,
    /// The input of the open group that feeds them.
    fed: Option<String>,
    slots: Vec<SlotRef>,
}

impl Border {
    fn around(document: &OpenDocument, ids: &BTreeSet<NodeId>, instance: &NodeId) -> Border {
        let mut border = Border {
            instance: instance.clone(),
            inputs: BTreeMap::new(),
            outputs: BTreeMap::new(),
            given: BTreeMap::new(),
            knobs: BTreeMap::new(),
            turned: BTreeMap::new(),
        };
        border.find_inputs(document, ids);
        let (_, outputs) = instances::ports(document.contents(), document.shown());
        for from in outputs.values().filter(|from| ids.contains(&from.node)) {
            border.give(document, from);
        }
        for id in ids {
            let readers = document.graph().readers(id.as_str()).into_iter();
            for slot in readers.filter(|slot| !ids.contains(&slot.node)) {
                if let Some(from) = connections::wire_into(document, &slot) {
                    border.give(document, from);
                }
            }
        }
        for (name, knob) in document.graph().exposed() {
            border.turn(name, knob, ids);
        }
        border
    }

    fn find_inputs(&mut self, document: &OpenDocument, ids: &BTreeSet<NodeId>) {
        let (inputs, _) = instances::ports(document.contents(), document.shown());
        let fed = inputs.values().flat_map(|input| &input.to);
        let mut slots: BTreeSet<SlotRef> = fed.filter(|slot| ids.contains(&slot.node)).cloned().collect();
        for id in ids {
            let tied = document.node(id).into_iter().flat_map(|node| &node.inputs);
            let outside = tied.filter(|(_, from)| !ids.contains(&from.node));
            slots.extend(outside.map(|(name, _)| SlotRef {
                node: id.clone(),
                name: name.clone(),
            }));
        }
        for slot in slots {
            let from = connections::wire_into(document, &slot)
                .filter(|from| !ids.contains(&from.node))
                .cloned();
            let fed = connections::feeder(document, document.shown(), &slot).map(str::to_owned);
            let same = self
                .inputs
                .values_mut()
                .find(|known| known.from == from && known.fed == fed);
            if let Some(known) = same {
                known.slots.push(slot);
                continue;
            }
            let name = free_name(&slot.name, '_', |name| self.inputs.contains_key(name));
            let slots = vec![slot];
            self.inputs.insert(name, Entrance { from, fed, slots });
        }
    }

    /// Gives a result to the outside.
    fn give(&mut self, document: &OpenDocument, from: &OutputRef) {
        let plain = connections::shortest(document, from);
        let known = self.given.get(&plain).cloned();
        let name = known.unwrap_or_else(|| {
            let port = document
                .face(&from.node)
                .and_then(|face| face.output(from.port.as_deref()));
            let stem = port.map_or("result", |port| port.name.as_str());
            free_name(stem, '_', |name| self.outputs.contains_key(name))
        });
        self.outputs.insert(name.clone(), plain.clone());
        self.given.insert(plain, name.clone());
        self.given.insert(from.clone(), name);
    }

    /// Has a knob on the panel outside turn what it turned.
    fn turn(&mut self, published: &str, knob: &Exposed, ids: &BTreeSet<NodeId>) {
        let to: Vec<SlotRef> = knob
            .to
            .iter()
            .filter(|slot| ids.contains(&slot.node))
            .cloned()
            .collect();
        if to.is_empty() {
            return;
        }
        let is_taken = |name: &str| self.knobs.contains_key(name) || INSTANCE_KNOBS.contains(&name);
        let name = free_name(published, '_', is_taken);
        self.turned.insert(published.to_owned(), name.clone());
        let inside = Exposed {
            to,
            label: knob.label.clone(),
            section: knob.section.clone(),
            order: knob.order,
            ..Exposed::default()
        };
        self.knobs.insert(name, inside);
    }

    fn slot(&self, name: &str) -> SlotRef {
        SlotRef {
            node: self.instance.clone(),
            name: name.to_owned(),
        }
    }
}

impl Heir for Border {
    fn knobs(&self, published: &str, _: &SlotRef) -> Vec<SlotRef> {
        let name = self.turned.get(published);
        name.map(|name| self.slot(name)).into_iter().collect()
    }

    fn inputs(&self, input: &SlotRef) -> Vec<SlotRef> {
        let fed = self.inputs.iter().filter(|(_, known)| known.fed.is_some());
        let found = fed.filter(|(_, known)| known.slots.contains(input));
        found.map(|(name, _)| self.slot(name)).collect()
    }

    fn output(&self, from: &OutputRef) -> Option<OutputRef> {
        Some(OutputRef {
            node: self.instance.clone(),
            port: Some(self.given.get(from)?.clone()),
        })
    }

    fn nodes(&self, _: &NodeId) -> Vec<NodeId> {
        vec![self.instance.clone()]
    }
}
