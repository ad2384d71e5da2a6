//! Reconnection of wires around removed nodes: readers are connected to the results that the nodes would pass on if they were muted.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Edit, GROUP_KIND, NodeId, OutputRef, REROUTE_KIND, SlotRef};

use crate::open_document::OpenDocument;
use crate::{connections, instances};

/// Maximum nesting of groups that is searched. Groups that are nested deeper cannot be evaluated.
const MOST_NESTED: usize = 256;

/// New source of an input after nodes before it are removed.
#[derive(Clone, Debug)]
struct NewSource {
    /// Output that the input is connected to.
    wire: Option<OutputRef>,
    /// The group's input that feeds it. In that case the wire is read only while nothing is connected to the group's input.
    fed: Option<String>,
}

/// Sources of an input: a group's input, a wire, or both.
type InputSources = (Option<String>, Option<OutputRef>);

/// Returns edits that connect all readers of these nodes, and the outputs of the group, to the results that the nodes pass on.
pub(crate) fn reconnecting(document: &OpenDocument, removed: &BTreeSet<NodeId>) -> Vec<Edit> {
    let mut search = SourceSearch::new(document, removed);
    let mut edits = Vec::new();
    let mut fed: BTreeMap<String, Vec<SlotRef>> = BTreeMap::new();
    for id in removed {
        let readers = document.graph().readers(id.as_str());
        for slot in readers.into_iter().filter(|slot| !removed.contains(&slot.node)) {
            let Some(from) = connections::wire_into(document, &slot) else {
                continue;
            };
            let source = search.source_behind(from);
            let fitting = source
                .wire
                .filter(|from| connections::check_type(document, from, &slot).is_ok());
            edits.push(match fitting {
                Some(from) => connections::connecting(document, &from, &slot),
                None => connections::disconnecting(document, &slot),
            });
            if let Some(input) = source
                .fed
                .filter(|_| connections::feeder(document, document.shown(), &slot).is_none())
            {
                fed.entry(input).or_default().push(slot);
            }
        }
    }
    let (inputs, outputs) = instances::ports(document.contents(), document.shown());
    for (name, slots) in fed {
        let Some(mut input) = inputs.get(&name).cloned() else {
            continue;
        };
        input.to.extend(slots);
        let (body, input) = (document.body(), Some(input));
        edits.push(Edit::SetInput { body, name, input });
    }
    for (name, from) in outputs.iter().filter(|(_, from)| removed.contains(&from.node)) {
        let same = |wire: &OutputRef| connections::carried(document, wire) == connections::carried(document, from);
        if let Some(wire) = search.source_behind(from).wire.filter(same) {
            let (body, name, output) = (document.body(), name.clone(), Some(wire));
            edits.push(Edit::SetOutput { body, name, output });
        }
    }
    edits
}

/// Search for the sources of wires behind nodes that pass an input on.
struct SourceSearch<'d> {
    document: &'d OpenDocument,
    removed: &'d BTreeSet<NodeId>,
    /// Inputs that a group passes on if all its nodes do, by group and output. Empty for a group whose search has not
    /// ended: a group that contains itself cannot be evaluated.
    passed_by_group: BTreeMap<(String, Option<String>), Vec<String>>,
    /// Number of nested groups that are being searched.
    depth: usize,
}

impl<'d> SourceSearch<'d> {
    fn new(document: &'d OpenDocument, removed: &'d BTreeSet<NodeId>) -> SourceSearch<'d> {
        SourceSearch {
            document,
            removed,
            passed_by_group: BTreeMap::new(),
            depth: 0,
        }
    }

    /// Returns the source of a wire if the removed nodes behave like muted nodes: each passes on the first of its inputs of
    /// the same type that leads to a node that stays.
    fn source_behind(&mut self, from: &OutputRef) -> NewSource {
        // Sources still to be followed, the next one last.
        let mut stack: Vec<InputSources> = vec![(None, Some(from.clone()))];
        let mut visited = BTreeSet::new();
        // The first input of the group that was met on the way. A wire found after it is read only while nothing is
        // connected to that input.
        let mut fed = None;
        // A wire that carries nothing now is better than no wire: the artist may unmute its node.
        let mut dead_end = None;
        while let Some((feeder, wire)) = stack.pop() {
            fed = fed.or(feeder);
            let Some(at) = wire else { continue };
            if !self.removed.contains(&at.node) {
                if self.leads_somewhere(&at) {
                    return NewSource { wire: Some(at), fed };
                }
                dead_end = dead_end.or(Some(at));
            } else if visited.insert(at.node.clone()) {
                let inputs = self.passed_inputs(self.document.shown(), &at);
                stack.extend(
                    inputs
                        .into_iter()
                        .rev()
                        .map(|input| self.sources(self.document.shown(), &at.node, input)),
                );
            }
        }
        NewSource { wire: dead_end, fed }
    }

    fn sources(&self, body: &Body, id: &NodeId, name: String) -> InputSources {
        let graph = self.document.graph_of(body);
        let wire = graph.and_then(|graph| graph.link_into(id.as_str(), &name).cloned());
        let slot = SlotRef { node: id.clone(), name };
        (connections::feeder(self.document, body, &slot).map(str::to_owned), wire)
    }

    /// Returns whether a wire carries a result: it does not start at a reroute or a muted node without a source.
    fn leads_somewhere(&mut self, from: &OutputRef) -> bool {
        let mut stack = vec![from.clone()];
        let mut visited = BTreeSet::new();
        while let Some(at) = stack.pop() {
            let Some(node) = self.document.node(&at.node) else {
                continue;
            };
            let is_wire = node.muted || node.kind == REROUTE_KIND || self.removed.contains(&at.node);
            if !is_wire {
                return true;
            }
            if !visited.insert(at.node.clone()) {
                continue;
            }
            for input in self.passed_inputs(self.document.shown(), &at) {
                let (fed, wire) = self.sources(self.document.shown(), &at.node, input);
                if fed.is_some() {
                    return true;
                }
                stack.extend(wire);
            }
        }
        false
    }

    /// Returns the inputs of a node that one of its outputs passes on while the node behaves like a muted one, in order.
    fn passed_inputs(&mut self, body: &Body, from: &OutputRef) -> Vec<String> {
        let document = self.document;
        let node = document.graph_of(body).and_then(|graph| graph.node(from.node.as_str()));
        let Some((node, interface)) = node.zip(document.interfaces().of(body, from.node.as_str())) else {
            return Vec::new();
        };
        let own = node.group.as_ref().filter(|_| node.kind == GROUP_KIND);
        if let Some(group) = own.filter(|name| document.contents().groups.contains_key(*name)) {
            return self.passed_inputs_of_group(group, from.port.as_deref());
        }
        let Some(port) = interface.output(from.port.as_deref()) else {
            return Vec::new();
        };
        let fitting = interface.plain_inputs().filter(|input| input.ty == port.ty);
        fitting.map(|input| input.name.clone()).collect()
    }

    /// Returns the inputs of a group that one of its outputs passes on while all nodes inside behave like muted ones.
    fn passed_inputs_of_group(&mut self, group: &str, port: Option<&str>) -> Vec<String> {
        let key = (group.to_owned(), port.map(str::to_owned));
        if let Some(known) = self.passed_by_group.get(&key) {
            return known.clone();
        }
        if self.depth == MOST_NESTED {
            return Vec::new();
        }
        self.depth += 1;
        self.passed_by_group.insert(key.clone(), Vec::new());
        let body = Body::Group(group.to_owned());
        let (_, outputs) = instances::ports(self.document.contents(), &body);
        let given = match port {
            Some(port) => outputs.get(port),
            None => outputs.values().next(),
        };
        // Sources still to be followed, the next one last.
        let mut stack: Vec<InputSources> = vec![(None, given.cloned())];
        let mut found: Vec<String> = Vec::new();
        let mut visited = BTreeSet::new();
        while let Some((feeder, wire)) = stack.pop() {
            found.extend(feeder.filter(|input| !found.contains(input)));
            let Some(at) = wire.filter(|at| visited.insert(at.node.clone())) else {
                continue;
            };
            let inputs = self.passed_inputs(&body, &at).into_iter().rev();
            stack.extend(inputs.map(|input| self.sources(&body, &at.node, input)));
        }
        self.passed_by_group.insert(key, found.clone());
        self.depth -= 1;
        found
    }
}
