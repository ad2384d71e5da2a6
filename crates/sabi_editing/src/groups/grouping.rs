//! Grouping: selected nodes are replaced by an instance of a new group. The results stay the same, and exposed knobs,
//! ports and frames refer to the instance.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{
    Body, Edit, ExposedParameter, GROUP_KIND, GroupDef, GroupInput, INSTANCE_KNOBS, KnobCurve, Node, NodeId, OutputRef,
    SlotRef,
};

use crate::duplication::frames_around;
use crate::names::free_name;
use crate::open_document::OpenDocument;
use crate::references::Successors;
use crate::{connections, groups, instances, new_nodes, references};

/// Makes a group of the selected nodes and replaces them by an instance.
pub fn make(document: &mut OpenDocument) -> bool {
    let ids = document.selection().clone();
    if ids.is_empty() {
        return document.refuse("select the nodes that a group should hold");
    }
    let mut interfaces = ids.iter().filter_map(|id| document.interface(id));
    if interfaces.any(|interface| interface.category() == "output") {
        return document.refuse("an output cannot be inside a group; leave it outside and group what leads to it");
    }
    if let Some(between) = first_between(document, &ids) {
        let title = document.title(&between);
        return document.refuse(format!("'{title}' lies between the selected nodes; select it too"));
    }
    let name = groups::free_name_for(document, "Group");
    let instance = document.new_id("group", &BTreeSet::new());
    let boundary = Boundary::of(document, &ids, &instance);
    let mut edits = definition(document, &name, &ids, &boundary);
    edits.extend(instance_edits(document, &name, &ids, &boundary));
    document.edit_and_select("Group", edits, [instance])
}

/// Returns the first node outside that depends on a node inside while another node inside depends on it: the group would
/// form a cycle with this node.
fn first_between(document: &OpenDocument, ids: &BTreeSet<NodeId>) -> Option<NodeId> {
    let (above, below) = (document.graph().upstream(ids), document.graph().downstream(ids));
    above.intersection(&below).find(|id| !ids.contains(*id)).cloned()
}

/// Edits that define the group.
fn definition(document: &OpenDocument, name: &str, ids: &BTreeSet<NodeId>, boundary: &Boundary) -> Vec<Edit> {
    let body = || Body::Group(name.to_owned());
    let fit = match document.shown() {
        Body::Main => None,
        // A group has the fit of the enclosing group, so that its lengths keep their meaning.
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
        let Some(node) = document.node(&id).cloned() else {
            continue;
        };
        edits.push(Edit::AddNode {
            body: body(),
            inputs: connections::wires_from(document.graph(), &id, |from| ids.contains(from)),
            id,
            node,
        });
    }
    edits.extend(boundary.inputs.iter().map(|(name, input)| Edit::SetInput {
        body: body(),
        name: name.clone(),
        input: Some(GroupInput {
            to: input.slots.clone(),
            ..GroupInput::default()
        }),
    }));
    edits.extend(boundary.outputs.iter().map(|(name, from)| Edit::SetOutput {
        body: body(),
        name: name.clone(),
        output: Some(from.clone()),
    }));
    edits.extend(boundary.knobs.iter().map(|(name, knob)| Edit::Expose {
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

/// Edits that replace the nodes by an instance.
fn instance_edits(document: &OpenDocument, name: &str, ids: &BTreeSet<NodeId>, boundary: &Boundary) -> Vec<Edit> {
    let mut node = Node::new(GROUP_KIND);
    node.group = Some(name.to_owned());
    let places = ids.iter().filter_map(|id| Some(document.node(id)?.pos));
    let sum = places.fold([0.0; 2], |sum, pos| [sum[0] + pos[0], sum[1] + pos[1]]);
    node.pos = sum.map(|sum| (sum / ids.len() as f32).round());
    let wired = boundary.inputs.iter();
    let wired = wired.filter_map(|(name, input)| Some((name.clone(), input.from.clone()?)));
    let mut edits = vec![new_nodes::addition(document, &boundary.instance, node, wired.collect())];
    for id in ids {
        let readers = document.graph().readers(id.as_str()).into_iter();
        for slot in readers.filter(|slot| !ids.contains(&slot.node)) {
            let from = connections::wire_into(document, &slot).and_then(|from| boundary.output(from));
            edits.extend(from.map(|from| Edit::Connect {
                body: document.body(),
                node: slot.node,
                input: slot.name,
                from,
            }));
        }
    }
    edits.extend(references::redirecting(document, ids, boundary));
    // Frames that contain no other nodes are moved into the group.
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

/// Inputs, outputs and exposed knobs of a new group, by their names.
struct Boundary {
    instance: NodeId,
    inputs: BTreeMap<String, BoundaryInput>,
    /// Outputs inside the group.
    outputs: BTreeMap<String, OutputRef>,
    /// Names of the group's outputs, for each form in which wires refer to an output.
    output_names: BTreeMap<OutputRef, String>,
    /// Exposed knobs of the new group.
    knobs: BTreeMap<String, ExposedParameter>,
    /// Name of the group's knob for each exposed knob of the enclosing graph.
    knob_names: BTreeMap<String, String>,
}

/// Input of the group: a source that one or more inputs inside share.
struct BoundaryInput {
    /// Output outside that is connected.
    from: Option<OutputRef>,
    /// Input of the shown group that feeds this input.
    fed: Option<String>,
    slots: Vec<SlotRef>,
}

impl Boundary {
    fn of(document: &OpenDocument, ids: &BTreeSet<NodeId>, instance: &NodeId) -> Boundary {
        let mut boundary = Boundary {
            instance: instance.clone(),
            inputs: BTreeMap::new(),
            outputs: BTreeMap::new(),
            output_names: BTreeMap::new(),
            knobs: BTreeMap::new(),
            knob_names: BTreeMap::new(),
        };
        boundary.find_inputs(document, ids);
        let (_, outputs) = instances::ports(document.contents(), document.shown());
        for from in outputs.values().filter(|from| ids.contains(&from.node)) {
            boundary.add_output(document, from);
        }
        for id in ids {
            let readers = document.graph().readers(id.as_str()).into_iter();
            for slot in readers.filter(|slot| !ids.contains(&slot.node)) {
                if let Some(from) = connections::wire_into(document, &slot) {
                    boundary.add_output(document, from);
                }
            }
        }
        for (name, knob) in document.graph().exposed() {
            boundary.add_knob(name, knob, ids);
        }
        boundary
    }

    fn find_inputs(&mut self, document: &OpenDocument, ids: &BTreeSet<NodeId>) {
        let (inputs, _) = instances::ports(document.contents(), document.shown());
        let fed = inputs.values().flat_map(|input| &input.to);
        let mut slots: BTreeSet<SlotRef> = fed.filter(|slot| ids.contains(&slot.node)).cloned().collect();
        for id in ids {
            let outside = connections::wires_from(document.graph(), id, |from| !ids.contains(from));
            slots.extend(outside.into_keys().map(|name| SlotRef { node: id.clone(), name }));
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
            self.inputs.insert(name, BoundaryInput { from, fed, slots });
        }
    }

    /// Adds an output of a node inside as an output of the group.
    fn add_output(&mut self, document: &OpenDocument, from: &OutputRef) {
        let plain = connections::canonical(document, from);
        let known = self.output_names.get(&plain).cloned();
        let name = known.unwrap_or_else(|| {
            let port = document
                .interface(&from.node)
                .and_then(|interface| interface.output(from.port.as_deref()));
            let stem = port.map_or("result", |port| port.name.as_str());
            free_name(stem, '_', |name| self.outputs.contains_key(name))
        });
        self.outputs.insert(name.clone(), plain.clone());
        self.output_names.insert(plain, name.clone());
        self.output_names.insert(from.clone(), name);
    }

    /// Exposes in the group the knobs of nodes inside that an exposed knob outside controls.
    fn add_knob(&mut self, exposed: &str, knob: &ExposedParameter, ids: &BTreeSet<NodeId>) {
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
        let name = free_name(exposed, '_', is_taken);
        self.knob_names.insert(exposed.to_owned(), name.clone());
        let mut inside = knob.with_targets(to);
        // The knob outside keeps range and default. Only a knob with curves needs its own default inside.
        inside.range = None;
        inside.default = inside.default.filter(|_| !inside.curves.is_empty());
        self.knobs.insert(name, inside);
    }

    fn slot(&self, name: &str) -> SlotRef {
        SlotRef {
            node: self.instance.clone(),
            name: name.to_owned(),
        }
    }
}

impl Successors for Boundary {
    fn knobs(&self, exposed: &str, _: &SlotRef) -> Vec<SlotRef> {
        let name = self.knob_names.get(exposed);
        name.map(|name| self.slot(name)).into_iter().collect()
    }

    fn curve(&self, _: Option<&KnobCurve>, _: &SlotRef, _: &SlotRef) -> Option<KnobCurve> {
        // The knob inside the group has the curve now.
        None
    }

    fn inputs(&self, input: &SlotRef) -> Vec<SlotRef> {
        let fed = self.inputs.iter().filter(|(_, known)| known.fed.is_some());
        let found = fed.filter(|(_, known)| known.slots.contains(input));
        found.map(|(name, _)| self.slot(name)).collect()
    }

    fn output(&self, from: &OutputRef) -> Option<OutputRef> {
        Some(OutputRef {
            node: self.instance.clone(),
            port: Some(self.output_names.get(from)?.clone()),
        })
    }

    fn nodes(&self, _: &NodeId) -> Vec<NodeId> {
        vec![self.instance.clone()]
    }
}
