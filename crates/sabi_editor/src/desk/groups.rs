//! Groups: making one of nodes, going in and out, and what it shows to those who use it.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Edit, Exposed, Frame, GROUP_KIND, GroupDef, GroupInput, NodeId, OutputRef, SlotRef, Value};

use super::Desk;

impl Desk {
    /// Instances that were entered, outermost first, each with what it is called: the path that a breadcrumb shows.
    pub(crate) fn path(&self) -> Vec<(NodeId, String)> {
        let bodies = self.bodies();
        let steps = self.inside.iter().zip(&bodies);
        let title = |(id, body): (&NodeId, &Body)| {
            let node = self.graph_of(body).and_then(|graph| graph.node(id.as_str()));
            let label = node.and_then(|node| node.label.clone().or_else(|| node.group.clone()));
            (id.clone(), label.unwrap_or_else(|| id.to_string()))
        };
        steps.take(bodies.len() - 1).map(title).collect()
    }

    /// Goes into a group instance.
    pub(crate) fn enter(&mut self, id: &NodeId) -> bool {
        let group = self
            .node(id)
            .filter(|node| node.kind == GROUP_KIND)
            .and_then(|node| node.group.clone());
        let Some(group) = group else {
            return false;
        };
        if !self.document().groups.contains_key(&group) {
            self.say(format!(
                "'{group}' is a file of its own; open it to change what is inside"
            ));
            return false;
        }
        self.inside.push(id.clone());
        self.selection.clear();
        true
    }

    /// Goes so many steps up at least; the instance that was left is selected.
    pub(crate) fn leave_to(&mut self, depth: usize) -> bool {
        let left = self.inside.get(depth).cloned();
        self.inside.truncate(depth);
        let has_left = left.is_some();
        if let Some(left) = left {
            self.select([left]);
        }
        has_left
    }

    /// Goes one step up.
    pub(crate) fn leave(&mut self) -> bool {
        match self.inside.len() {
            0 => false,
            depth => self.leave_to(depth - 1),
        }
    }

    /// Makes a group of the selected nodes and puts an instance in their place.
    pub(crate) fn make_group(&mut self) -> bool {
        let ids = self.selection.clone();
        if ids.is_empty() {
            self.say("select the nodes that a group should hold");
            return false;
        }
        if ids
            .iter()
            .any(|id| self.face(id).is_some_and(|face| face.category() == "output"))
        {
            self.say("an output cannot be inside a group; leave it outside and group what leads to it");
            return false;
        }
        if let Some(between) = self.first_between(&ids) {
            let title = self.title(&between);
            self.say(format!("'{title}' lies between the selected nodes; select it too"));
            return false;
        }
        let name = self.free_group_name("Group");
        let wires = Wires::around(self, &ids);
        let mut edits = self.definition(&name, &ids, &wires);
        let instance = self.new_id("group", &BTreeSet::new());
        edits.extend(self.instance_edits(&name, &instance, &ids, &wires));
        let is_made = self.edit("Group", edits);
        if is_made {
            self.select([instance]);
        }
        is_made
    }

    /// A node outside that is made from nodes inside and that nodes inside are made from: a group would lead in a circle.
    fn first_between(&self, ids: &BTreeSet<NodeId>) -> Option<NodeId> {
        let reached = |is_upstream: bool| {
            let mut seen = BTreeSet::new();
            let mut next: Vec<NodeId> = ids.iter().cloned().collect();
            while let Some(id) = next.pop() {
                for neighbor in self.neighbors(&id, is_upstream) {
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

    pub(super) fn free_group_name(&self, stem: &str) -> String {
        let is_free = |name: &str| !self.document().groups.contains_key(name);
        let numbered = (2..).map(|number| format!("{stem} {number}"));
        let mut names = std::iter::once(stem.to_owned()).chain(numbered);
        names.find(|name| is_free(name)).unwrap_or_else(|| stem.to_owned())
    }

    /// The edits that define a group of the nodes.
    fn definition(&self, name: &str, ids: &BTreeSet<NodeId>, wires: &Wires) -> Vec<Edit> {
        let body = Body::Group(name.to_owned());
        let mut edits = vec![Edit::AddGroup {
            name: name.to_owned(),
            group: Box::default(),
        }];
        for id in self
            .graph()
            .topological_order()
            .into_iter()
            .filter(|id| ids.contains(id))
        {
            let Some(mut node) = self.node(&id).cloned() else {
                continue;
            };
            node.inputs.retain(|_, from| ids.contains(&from.node));
            edits.push(Edit::AddNode {
                body: body.clone(),
                id,
                node,
            });
        }
        edits.extend(wires.inputs.iter().map(|(name, (_, to))| Edit::SetInput {
            body: body.clone(),
            name: name.clone(),
            input: Some(GroupInput {
                to: to.clone(),
                ..GroupInput::default()
            }),
        }));
        edits.extend(wires.outputs.iter().map(|(name, (from, _))| Edit::SetOutput {
            body: body.clone(),
            name: name.clone(),
            output: Some(from.clone()),
        }));
        edits
    }

    /// The edits that put an instance in the place of the nodes.
    fn instance_edits(&self, name: &str, instance: &NodeId, ids: &BTreeSet<NodeId>, wires: &Wires) -> Vec<Edit> {
        let mut node = sabi_graph::Node::new(GROUP_KIND);
        node.group = Some(name.to_owned());
        let places = ids.iter().filter_map(|id| Some(self.node(id)?.pos));
        let sum = places.fold([0.0; 2], |sum, pos| [sum[0] + pos[0], sum[1] + pos[1]]);
        node.pos = sum.map(|sum| (sum / ids.len() as f32).round());
        let inputs = wires.inputs.iter();
        node.inputs = inputs.map(|(name, (from, _))| (name.clone(), from.clone())).collect();
        let mut edits = vec![self.adding(instance, node)];
        for (name, (_, readers)) in &wires.outputs {
            edits.extend(readers.iter().map(|slot| Edit::Connect {
                body: self.body(),
                node: slot.node.clone(),
                input: slot.name.clone(),
                from: OutputRef {
                    node: instance.clone(),
                    port: Some(name.clone()),
                },
            }));
        }
        edits.extend(ids.iter().map(|id| Edit::RemoveNode {
            body: self.body(),
            id: id.clone(),
        }));
        edits
    }

    /// Puts what is inside the selected instances in their place, and takes away groups that nobody uses any more.
    pub(crate) fn dissolve_groups(&mut self) -> bool {
        let ids: Vec<NodeId> = self.selection.iter().cloned().collect();
        let mut is_made = false;
        self.session.begin("Ungroup");
        for id in ids {
            is_made |= self.dissolve(&id);
        }
        self.session.end();
        self.refresh();
        is_made
    }

    fn dissolve(&mut self, id: &NodeId) -> bool {
        let Some(instance) = self.node(id).cloned() else {
            return false;
        };
        let Some(name) = instance.group.clone() else {
            return false;
        };
        let Some(group) = self.document().groups.get(&name).cloned() else {
            return false;
        };
        let inner: BTreeMap<NodeId, sabi_graph::Node> = group
            .graph
            .nodes()
            .map(|(id, node)| (id.clone(), node.clone()))
            .collect();
        let corner = inner.values().fold([f32::INFINITY; 2], |corner, node| {
            [corner[0].min(node.pos[0]), corner[1].min(node.pos[1])]
        });
        let offset = [0, 1].map(|axis| {
            if corner[axis].is_finite() {
                instance.pos[axis] - corner[axis]
            } else {
                0.0
            }
        });
        let copies = self.copies(&inner, false, offset);
        let new_id: BTreeMap<&NodeId, NodeId> = inner.keys().zip(copies.iter().map(|(id, _)| id.clone())).collect();
        let ids: Vec<NodeId> = copies.iter().map(|(id, _)| id.clone()).collect();
        let mut edits = self.adding_all(with_knobs(copies, &group, &instance, &new_id));
        let body = self.body();
        for (name, from) in &instance.inputs {
            let fed = group.inputs.get(name).into_iter().flat_map(|input| &input.to);
            edits.extend(fed.filter_map(|slot| {
                Some(Edit::Connect {
                    body: body.clone(),
                    node: new_id.get(&slot.node)?.clone(),
                    input: slot.name.clone(),
                    from: from.clone(),
                })
            }));
        }
        for slot in self.graph().readers(id.as_str()) {
            let port = self.wire_into(&slot).and_then(|from| from.port.clone());
            let first = group.outputs.keys().next().cloned();
            let given = port.or(first).and_then(|port| group.outputs.get(&port));
            let from = given.and_then(|from| {
                Some(OutputRef {
                    node: new_id.get(&from.node)?.clone(),
                    port: from.port.clone(),
                })
            });
            edits.extend(from.map(|from| Edit::Connect {
                body: body.clone(),
                node: slot.node.clone(),
                input: slot.name.clone(),
                from,
            }));
        }
        edits.push(Edit::RemoveNode { body, id: id.clone() });
        let is_made = self.edit("Ungroup", edits);
        if is_made {
            self.selection.extend(ids);
            // Others may use it still, and then it stays without a word.
            let unused = Edit::RemoveGroup { name };
            let _ = self.session.edit("Ungroup", unused);
        }
        is_made
    }

    /// Publishes a knob of a node under a name of its own on the panel of the graph that is seen.
    pub(crate) fn expose(&mut self, id: &NodeId, knob: &str) -> bool {
        let exposed = self.graph().exposed();
        let numbered = (2..).map(|number| format!("{knob}_{number}"));
        let mut names = std::iter::once(knob.to_owned()).chain(numbered);
        let Some(name) = names.find(|name| !exposed.contains_key(name)) else {
            return false;
        };
        let label = self
            .face(id)
            .and_then(|face| face.knob(knob))
            .map(|knob| knob.label.clone());
        let edit = Edit::Expose {
            body: self.body(),
            name,
            knob: Exposed {
                to: vec![SlotRef {
                    node: id.clone(),
                    name: knob.to_owned(),
                }],
                label,
                ..Exposed::default()
            },
        };
        self.edit("Expose", vec![edit])
    }

    /// The name under which a knob of a node is published.
    pub(crate) fn exposed_as(&self, id: &NodeId, knob: &str) -> Option<&str> {
        let turns = |slot: &SlotRef| slot.node == *id && slot.name == knob;
        let mut exposed = self.graph().exposed().iter();
        exposed
            .find(|(_, known)| known.to.iter().any(turns))
            .map(|(name, _)| name.as_str())
    }

    /// Takes a published knob back.
    pub(crate) fn unexpose(&mut self, name: &str) -> bool {
        let edit = Edit::Unexpose {
            body: self.body(),
            name: name.to_owned(),
        };
        self.edit("Take off the panel", vec![edit])
    }
}

/// Wires that lead into and out of some nodes: each becomes an input or an output, by a name.
struct Wires {
    /// Where it comes from outside, and the inputs inside that read it.
    inputs: BTreeMap<String, (OutputRef, Vec<SlotRef>)>,
    /// Where it comes from inside, and the inputs outside that read it.
    outputs: BTreeMap<String, (OutputRef, Vec<SlotRef>)>,
}

impl Wires {
    fn around(desk: &Desk, ids: &BTreeSet<NodeId>) -> Wires {
        let mut wires = Wires {
            inputs: BTreeMap::new(),
            outputs: BTreeMap::new(),
        };
        for id in ids {
            let Some(node) = desk.node(id) else { continue };
            for (input, from) in node.inputs.iter().filter(|(_, from)| !ids.contains(&from.node)) {
                let slot = SlotRef {
                    node: id.clone(),
                    name: input.clone(),
                };
                put(&mut wires.inputs, input, from, slot);
            }
            for slot in desk.graph().readers(id.as_str()) {
                let Some(from) = desk.wire_into(&slot).filter(|_| !ids.contains(&slot.node)) else {
                    continue;
                };
                let face = desk.face(id);
                let port = face.and_then(|face| face.output(from.port.as_deref()));
                let name = port.map_or("result", |port| port.name.as_str());
                put(&mut wires.outputs, name, from, slot);
            }
        }
        wires
    }
}

/// Puts a wire with the others from the same place, or under a free name.
fn put(wires: &mut BTreeMap<String, (OutputRef, Vec<SlotRef>)>, stem: &str, from: &OutputRef, slot: SlotRef) {
    if let Some((_, slots)) = wires.values_mut().find(|(known, _)| known == from) {
        slots.push(slot);
        return;
    }
    let numbered = (2..).map(|number| format!("{stem}_{number}"));
    let free = std::iter::once(stem.to_owned())
        .chain(numbered)
        .find(|name| !wires.contains_key(name));
    if let Some(free) = free {
        wires.insert(free, (from.clone(), vec![slot]));
    }
}

/// The edits that publish what another definition of a group publishes, and its frames.
pub(super) fn publishing(body: &Body, group: &GroupDef) -> Vec<Edit> {
    let inputs = group.inputs.iter().map(|(name, input)| Edit::SetInput {
        body: body.clone(),
        name: name.clone(),
        input: Some(input.clone()),
    });
    let outputs = group.outputs.iter().map(|(name, output)| Edit::SetOutput {
        body: body.clone(),
        name: name.clone(),
        output: Some(output.clone()),
    });
    let knobs = group.graph.exposed().iter().map(|(name, knob)| Edit::Expose {
        body: body.clone(),
        name: name.clone(),
        knob: knob.clone(),
    });
    let variants = group.graph.variants().iter().map(|(name, values)| Edit::SetVariant {
        body: body.clone(),
        name: name.clone(),
        values: Some(values.clone()),
    });
    let frames = group
        .graph
        .frames()
        .iter()
        .map(|(id, frame): (&String, &Frame)| Edit::AddFrame {
            body: body.clone(),
            id: id.clone(),
            frame: frame.clone(),
        });
    inputs
        .chain(outputs)
        .chain(knobs)
        .chain(variants)
        .chain(frames)
        .collect()
}

/// Copies of a group's nodes with what the instance's knobs set: those of its variant first, then its own.
fn with_knobs(
    mut copies: Vec<(NodeId, sabi_graph::Node)>,
    group: &GroupDef,
    instance: &sabi_graph::Node,
    new_id: &BTreeMap<&NodeId, NodeId>,
) -> Vec<(NodeId, sabi_graph::Node)> {
    let variant = instance.params.get("variant").and_then(Value::as_text);
    let of_variant = variant.and_then(|name| group.graph.variants().get(name));
    for (name, exposed) in group.graph.exposed() {
        let set = instance.params.get(name);
        let value = set.or_else(|| of_variant?.get(name)).or(exposed.default.as_ref());
        let Some(value) = value else { continue };
        for slot in &exposed.to {
            let copy = copies.iter_mut().find(|(id, _)| Some(id) == new_id.get(&slot.node));
            if let Some((_, node)) = copy {
                node.params.insert(slot.name.clone(), value.clone());
            }
        }
    }
    copies
}
