//! Inputs and outputs of the graph that is seen, for those who use it as a group. Instances follow.

use std::collections::BTreeMap;

use sabi_graph::{Body, Edit, Exposed, GroupInput, NodeId, OutputRef, PortType, SlotRef};

use super::groups::free_name;
use super::{OpenDocument, PendingWire, group_instances};

impl OpenDocument {
    /// Inputs of the graph that is seen.
    pub fn group_inputs(&self) -> &BTreeMap<String, GroupInput> {
        group_instances::ports(self.contents(), &self.seen).0
    }

    /// Outputs of the graph that is seen.
    pub fn group_outputs(&self) -> &BTreeMap<String, OutputRef> {
        group_instances::ports(self.contents(), &self.seen).1
    }

    /// Makes an input of the group out of one of a node; gives its name.
    pub fn publish_input(&mut self, slot: &SlotRef) -> Option<String> {
        let name = free_name(&slot.name, '_', |name| self.group_inputs().contains_key(name));
        let input = GroupInput {
            to: vec![slot.clone()],
            ..GroupInput::default()
        };
        if let Err(why) = self.may_feed(None, slot) {
            self.say(why);
            return None;
        }
        let edit = self.setting_input(&name, Some(input));
        self.edit("Add input", vec![edit]).then_some(name)
    }

    /// Has an input of the group feed an input of a node too.
    pub fn feed(&mut self, name: &str, slot: &SlotRef) -> bool {
        let Some(mut input) = self.group_inputs().get(name).cloned() else {
            return self.refuse(format!("the group has no input '{name}'"));
        };
        if input.to.contains(slot) {
            return true;
        }
        if let Err(why) = self.may_feed(Some(&input), slot) {
            return self.refuse(why);
        }
        let mut edits = Vec::new();
        // Fed by one input at most: the last one that was asked for.
        if let Some((other, mut known)) = self.feeding(slot) {
            known.to.retain(|fed| fed != slot);
            edits.push(self.setting_input(&other, Some(known)));
        }
        input.to.push(slot.clone());
        edits.push(self.setting_input(name, Some(input)));
        self.edit("Connect input", edits)
    }

    /// Takes an input of a node off the group's input that feeds it.
    pub fn unfeed(&mut self, slot: &SlotRef) -> bool {
        let Some((name, mut input)) = self.feeding(slot) else {
            return false;
        };
        input.to.retain(|fed| fed != slot);
        let edit = self.setting_input(&name, Some(input));
        self.edit("Disconnect input", vec![edit])
    }

    /// Inputs of these nodes that inputs of the group feed, each with the name of that one.
    pub(super) fn fed_by_group(&self, is_meant: impl Fn(&NodeId) -> bool) -> Vec<(SlotRef, String)> {
        let inputs = self.group_inputs().iter();
        let slots = inputs.flat_map(|(name, input)| input.to.iter().map(move |slot| (slot.clone(), name.clone())));
        slots.filter(|(slot, _)| is_meant(&slot.node)).collect()
    }

    /// Has each of these inputs fed by that input of the group, or by none, besides what the edits do already.
    pub(super) fn refeed(&self, edits: &mut Vec<Edit>, fed: Vec<(SlotRef, Option<String>)>) {
        let feeds = |name: &str, slot: &SlotRef| fed.iter().any(|(to, by)| to == slot && by.as_deref() == Some(name));
        for (name, input) in self.group_inputs() {
            let made = edits
                .iter()
                .rposition(|edit| matches!(edit, Edit::SetInput { name: set, .. } if set == name));
            let by_edits = made.and_then(|at| match &edits[at] {
                Edit::SetInput { input, .. } => input.clone(),
                _ => None,
            });
            let before = by_edits.unwrap_or_else(|| input.clone());
            let mut after = before.clone();
            after
                .to
                .retain(|slot| feeds(name, slot) || fed.iter().all(|(known, _)| known != slot));
            for (slot, _) in &fed {
                if feeds(name, slot) && !after.to.contains(slot) {
                    after.to.push(slot.clone());
                }
            }
            if after != before {
                edits.push(self.setting_input(name, Some(after)));
            }
        }
    }

    fn feeding(&self, slot: &SlotRef) -> Option<(String, GroupInput)> {
        let name = self.feeder(&self.seen, slot)?.to_owned();
        let input = self.group_inputs().get(&name)?.clone();
        Some((name, input))
    }

    /// Why an input cannot feed an input of a node.
    fn may_feed(&self, input: Option<&GroupInput>, slot: &SlotRef) -> Result<(), String> {
        let Some(port) = self.input(slot) else {
            return Err(format!("'{}' has no input '{}'", self.title(&slot.node), slot.name));
        };
        let Some(input) = input else {
            return match self.feeder(&self.seen, slot) {
                Some(name) => Err(format!("the group's input '{name}' leads there already")),
                None => Ok(()),
            };
        };
        let fed = input.to.iter().find_map(|slot| self.input(slot)?.ty);
        let carried: Option<PortType> = input.ty.or(fed);
        match (carried, port.ty) {
            (Some(carried), Some(takes)) if !takes.accepts(carried) => Err(format!(
                "'{}' takes a {takes}, and this input of the group carries a {carried}",
                port.label
            )),
            _ => Ok(()),
        }
    }

    /// Inputs of nodes that an input of the group could feed too: those that nothing leads to.
    pub fn feedable(&self, name: &str) -> Vec<SlotRef> {
        let Some(input) = self.group_inputs().get(name) else {
            return Vec::new();
        };
        let all = self.graph().ids().flat_map(|id| {
            let ports = self.face(id).map(|face| face.inputs.as_slice()).unwrap_or_default();
            ports.iter().map(|port| SlotRef {
                node: id.clone(),
                name: port.name.clone(),
            })
        });
        let is_free = |slot: &SlotRef| self.wire_into(slot).is_none() && self.feeder(&self.seen, slot).is_none();
        all.filter(|slot| is_free(slot) && self.may_feed(Some(input), slot).is_ok())
            .collect()
    }

    /// All results of the nodes that are seen.
    pub fn results(&self) -> Vec<OutputRef> {
        let all = self.graph().ids().flat_map(|id| {
            let ports = self.face(id).map(|face| face.outputs.as_slice()).unwrap_or_default();
            ports.iter().map(|port| OutputRef {
                node: id.clone(),
                port: Some(port.name.clone()),
            })
        });
        all.collect()
    }

    /// The name under which the graph gives a port on to those who use it as a group.
    pub fn given_as(&self, port: &PendingWire) -> Option<&str> {
        match port {
            PendingWire::Into(slot) => self.feeder(&self.seen, slot),
            PendingWire::From(result) => {
                let result = self.shortest(result);
                let mut outputs = self.group_outputs().iter();
                let given = outputs.find(|(_, from)| self.shortest(from) == result);
                given.map(|(name, _)| name.as_str())
            }
        }
    }

    /// Whether an input of a node reads this result.
    pub fn reads(&self, slot: &SlotRef, from: &OutputRef) -> bool {
        let read = self.wire_into(slot);
        read.is_some_and(|read| self.shortest(read) == self.shortest(from))
    }

    /// Removes an input of the group.
    pub fn remove_input(&mut self, name: &str) -> bool {
        let edit = self.setting_input(name, None);
        self.edit("Remove input", vec![edit])
    }

    /// Gives an input of the group the name that artists see, or its own one back.
    pub fn label_input(&mut self, name: &str, label: &str) -> bool {
        let Some(input) = self.group_inputs().get(name).cloned() else {
            return self.refuse(format!("the group has no input '{name}'"));
        };
        let label = Some(label.trim().to_owned()).filter(|label| !label.is_empty());
        let edit = self.setting_input(name, Some(GroupInput { label, ..input }));
        self.edit("Rename input", vec![edit])
    }

    /// Gives an input of the group another name in files, and in all its instances.
    pub fn rename_input(&mut self, name: &str, to: &str) -> bool {
        let to = to.trim();
        let Some(input) = self.group_inputs().get(name).cloned() else {
            return self.refuse(format!("the group has no input '{name}'"));
        };
        if name == to {
            return true;
        }
        if self.group_inputs().contains_key(to) {
            return self.refuse(format!("the group has an input '{to}' already; choose another name"));
        }
        let mut edits = vec![self.setting_input(name, None), self.setting_input(to, Some(input))];
        for (body, id, node) in self.instances_of_seen() {
            let Some(from) = node.inputs.get(name).cloned() else {
                continue;
            };
            let (node, input) = (id.clone(), name.to_owned());
            edits.push(Edit::Disconnect {
                body: body.clone(),
                node: node.clone(),
                input,
            });
            let (body, input) = (body.clone(), to.to_owned());
            edits.push(Edit::Connect {
                body,
                node,
                input,
                from,
            });
        }
        let is_ours = self.is_of_instance();
        edits.extend(self.renamed_inputs(|body, slot| is_ours(body, slot) && slot.name == name, to));
        self.edit("Rename input", edits)
    }

    /// Edits by which inputs of the groups around feed slots by their new name.
    fn renamed_inputs(&self, is_meant: impl Fn(&Body, &SlotRef) -> bool, to: &str) -> Vec<Edit> {
        let mut edits = Vec::new();
        for (body, _) in group_instances::bodies(self.contents()) {
            for (name, input) in group_instances::ports(self.contents(), &body).0 {
                let mut input = input.clone();
                if renamed(&mut input.to, |slot| is_meant(&body, slot), to) {
                    let (body, name, input) = (body.clone(), name.clone(), Some(input));
                    edits.push(Edit::SetInput { body, name, input });
                }
            }
        }
        edits
    }

    /// Edits by which knobs of the panels around turn slots by their new name.
    pub(super) fn renamed_knobs(&self, is_meant: impl Fn(&Body, &SlotRef) -> bool, to: &str) -> Vec<Edit> {
        let mut edits = Vec::new();
        for (body, graph) in group_instances::bodies(self.contents()) {
            for (name, knob) in graph.exposed() {
                let mut knob: Exposed = knob.clone();
                if renamed(&mut knob.to, |slot| is_meant(&body, slot), to) {
                    let (body, name) = (body.clone(), name.clone());
                    edits.push(Edit::Expose { body, name, knob });
                }
            }
        }
        edits
    }

    /// Makes an output of the group out of a result; gives its name.
    pub fn publish_output(&mut self, from: &OutputRef) -> Option<String> {
        let port = self.face(&from.node).and_then(|face| face.output(from.port.as_deref()));
        let Some(stem) = port.map(|port| port.name.clone()) else {
            self.say(format!("'{}' gives no such result", self.title(&from.node)));
            return None;
        };
        let name = free_name(&stem, '_', |name| self.group_outputs().contains_key(name));
        let edit = self.setting_output(&name, Some(self.shortest(from)));
        self.edit("Add output", vec![edit]).then_some(name)
    }

    /// Has an output of the group give another result.
    pub fn retarget_output(&mut self, name: &str, from: &OutputRef) -> bool {
        if !self.group_outputs().contains_key(name) {
            return self.refuse(format!("the group has no output '{name}'"));
        }
        let face = self.face(&from.node);
        if face.and_then(|face| face.output(from.port.as_deref())).is_none() {
            let title = self.title(&from.node);
            return self.refuse(format!("'{title}' gives no such result"));
        }
        let edit = self.setting_output(name, Some(self.shortest(from)));
        self.edit("Connect output", vec![edit])
    }

    /// Removes an output of the group.
    pub fn remove_output(&mut self, name: &str) -> bool {
        let edit = self.setting_output(name, None);
        self.edit("Remove output", vec![edit])
    }

    /// Gives an output of the group another name, in all its instances.
    pub fn rename_output(&mut self, name: &str, to: &str) -> bool {
        let to = to.trim();
        let Some(output) = self.group_outputs().get(name).cloned() else {
            return self.refuse(format!("the group has no output '{name}'"));
        };
        if name == to {
            return true;
        }
        if self.group_outputs().contains_key(to) {
            return self.refuse(format!("the group has an output '{to}' already; choose another name"));
        }
        let mut edits = vec![self.setting_output(name, None), self.setting_output(to, Some(output))];
        for (body, id, _) in self.instances_of_seen() {
            let Some(graph) = self.graph_of(&body) else { continue };
            let renamed = OutputRef {
                node: id.clone(),
                port: Some(to.to_owned()),
            };
            let is_meant = |from: &&OutputRef| from.node == id && from.port.as_deref() == Some(name);
            for slot in graph.readers(id.as_str()) {
                let tied = graph
                    .node(slot.node.as_str())
                    .and_then(|node| node.inputs.get(&slot.name));
                edits.extend(tied.filter(is_meant).map(|_| Edit::Connect {
                    body: body.clone(),
                    node: slot.node,
                    input: slot.name,
                    from: renamed.clone(),
                }));
            }
            let (_, outputs) = group_instances::ports(self.contents(), &body);
            for (outer, _) in outputs.iter().filter(|(_, from)| is_meant(from)) {
                let (body, name, output) = (body.clone(), outer.clone(), Some(renamed.clone()));
                edits.push(Edit::SetOutput { body, name, output });
            }
        }
        self.edit("Rename output", edits)
    }

    /// Instances of the group that is seen, wherever they are.
    pub(super) fn instances_of_seen(&self) -> Vec<(Body, sabi_graph::NodeId, sabi_graph::Node)> {
        let Body::Group(open) = &self.seen else {
            return Vec::new();
        };
        let bodies = group_instances::bodies(self.contents()).into_iter();
        let found = bodies.flat_map(|(body, graph)| {
            group_instances::instances(graph, open).map(move |(id, node)| (body.clone(), id.clone(), node.clone()))
        });
        found.collect()
    }

    /// Tells slots of instances of the group that is seen.
    pub(super) fn is_of_instance(&self) -> impl Fn(&Body, &SlotRef) -> bool + use<> {
        let found = self.instances_of_seen().into_iter();
        let found: std::collections::BTreeSet<(Body, sabi_graph::NodeId)> =
            found.map(|(body, id, _)| (body, id)).collect();
        move |body: &Body, slot: &SlotRef| found.contains(&(body.clone(), slot.node.clone()))
    }

    fn setting_input(&self, name: &str, input: Option<GroupInput>) -> Edit {
        Edit::SetInput {
            body: self.body(),
            name: name.to_owned(),
            input,
        }
    }

    fn setting_output(&self, name: &str, output: Option<OutputRef>) -> Edit {
        Edit::SetOutput {
            body: self.body(),
            name: name.to_owned(),
            output,
        }
    }
}

/// Renames the slots that are meant; says whether there were any.
fn renamed(slots: &mut [SlotRef], is_meant: impl Fn(&SlotRef) -> bool, to: &str) -> bool {
    let mut is_changed = false;
    for slot in slots.iter_mut().filter(|slot| is_meant(slot)) {
        slot.name = to.to_owned();
        is_changed = true;
    }
    is_changed
}
