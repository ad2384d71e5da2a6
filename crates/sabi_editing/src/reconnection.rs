//! Wires heal behind nodes that go, as if these had been pieces of wire: what muting them would give.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Edit, GROUP_KIND, NodeId, OutputRef, REROUTE_KIND, SlotRef};

use crate::open_document::OpenDocument;
use crate::{connections, instances};

/// Groups inside groups beyond this pass nothing on; no evaluation takes them.
const DEEPEST: usize = 256;

/// What a reader gets when nodes before it are gone.
#[derive(Clone, Debug, Default)]
struct Passed {
    /// What it reads.
    wire: Option<OutputRef>,
    /// The group's input that feeds it; the wire is then what it reads while nothing is connected to that.
    fed: Option<String>,
}

/// What leads to an input: a group's input, a wire, or both.
type Sources = (Option<String>, Option<OutputRef>);

/// The edits that tie everybody who reads these nodes to what the nodes pass on, the group's outputs too.
pub(crate) fn around(document: &OpenDocument, gone: &BTreeSet<NodeId>) -> Vec<Edit> {
    let mut behind = Behind::new(document, gone);
    let mut edits = Vec::new();
    let mut fed: BTreeMap<String, Vec<SlotRef>> = BTreeMap::new();
    for id in gone {
        let readers = document.graph().readers(id.as_str());
        for slot in readers.into_iter().filter(|slot| !gone.contains(&slot.node)) {
            let passed = connections::wire_into(document, &slot).map(|from| behind.passed_on(from));
            let passed = passed.unwrap_or_default();
            let fitting = passed
                .wire
                .filter(|from| connections::check_type(document, from, &slot).is_ok());
            edits.push(match fitting {
                Some(from) => connections::connecting(document, &from, &slot),
                None => connections::disconnecting(document, &slot),
            });
            if let Some(input) = passed
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
    for (name, from) in outputs.iter().filter(|(_, from)| gone.contains(&from.node)) {
        let same = |wire: &OutputRef| connections::carried(document, wire) == connections::carried(document, from);
        if let Some(wire) = behind.passed_on(from).wire.filter(same) {
            let (body, name, output) = (document.body(), name.clone(), Some(wire));
            edits.push(Edit::SetOutput { body, name, output });
        }
    }
    edits
}

/// What lies behind nodes that are mere wires.
struct Behind<'d> {
    document: &'d OpenDocument,
    gone: &'d BTreeSet<NodeId>,
    /// Inputs that come out of groups all of whose nodes are wires, by group and output. One that is being looked at passes
    /// nothing on: a group that holds itself is evaluated by nobody.
    inside: BTreeMap<(String, Option<String>), Vec<String>>,
    /// How many of them are being looked at.
    depth: usize,
}

impl<'d> Behind<'d> {
    fn new(document: &'d OpenDocument, gone: &'d BTreeSet<NodeId>) -> Behind<'d> {
        Behind {
            document,
            gone,
            inside: BTreeMap::new(),
            depth: 0,
        }
    }

    /// What comes out of a wire when the nodes that go are wires, as muted ones are: of their inputs of the same type the
    /// first that leads to a node which is none.
    fn passed_on(&mut self, from: &OutputRef) -> Passed {
        // Those not asked yet, the next one last.
        let mut ways: Vec<Sources> = vec![(None, Some(from.clone()))];
        let mut asked = BTreeSet::new();
        // The group's input that was met first: what is met after it is read while nothing is connected to that.
        let mut fed = None;
        // A wire that nothing comes out of now is better than none: the artist may let its node speak again.
        let mut silent = None;
        while let Some((feeder, wire)) = ways.pop() {
            fed = fed.or(feeder);
            let Some(at) = wire else { continue };
            if !self.gone.contains(&at.node) {
                if self.leads_somewhere(&at) {
                    return Passed { wire: Some(at), fed };
                }
                silent = silent.or(Some(at));
            } else if asked.insert(at.node.clone()) {
                let inputs = self.passing(self.document.shown(), &at);
                ways.extend(
                    inputs
                        .into_iter()
                        .rev()
                        .map(|input| self.sources(self.document.shown(), &at.node, input)),
                );
            }
        }
        Passed { wire: silent, fed }
    }

    fn sources(&self, body: &Body, id: &NodeId, name: String) -> Sources {
        let node = self.document.graph_of(body).and_then(|graph| graph.node(id.as_str()));
        let wire = node.and_then(|node| node.inputs.get(&name).cloned());
        let slot = SlotRef { node: id.clone(), name };
        (connections::feeder(self.document, body, &slot).map(str::to_owned), wire)
    }

    /// Whether something comes out of a wire: it does not begin at a reroute or a muted node with nothing behind it.
    fn leads_somewhere(&mut self, from: &OutputRef) -> bool {
        let mut ways = vec![from.clone()];
        let mut asked = BTreeSet::new();
        while let Some(at) = ways.pop() {
            let Some(node) = self.document.node(&at.node) else {
                continue;
            };
            let is_wire = node.muted || node.kind == REROUTE_KIND || self.gone.contains(&at.node);
            if !is_wire {
                return true;
            }
            if !asked.insert(at.node.clone()) {
                continue;
            }
            for input in self.passing(self.document.shown(), &at) {
                let (fed, wire) = self.sources(self.document.shown(), &at.node, input);
                if fed.is_some() {
                    return true;
                }
                ways.extend(wire);
            }
        }
        false
    }

    /// Inputs of a node that come out of a result of it while it is a mere wire, the first one first.
    fn passing(&mut self, body: &Body, from: &OutputRef) -> Vec<String> {
        let document = self.document;
        let node = document.graph_of(body).and_then(|graph| graph.node(from.node.as_str()));
        let Some((node, face)) = node.zip(document.faces().of(body, from.node.as_str())) else {
            return Vec::new();
        };
        let own = node.group.as_ref().filter(|_| node.kind == GROUP_KIND);
        if let Some(group) = own.filter(|name| document.contents().groups.contains_key(*name)) {
            return self.passing_inside(group, from.port.as_deref());
        }
        let Some(port) = face.output(from.port.as_deref()) else {
            return Vec::new();
        };
        let fitting = face.inputs.iter().filter(|input| input.ty == port.ty);
        fitting.map(|input| input.name.clone()).collect()
    }

    /// Inputs of a group that come out of one of its results while all nodes inside are mere wires.
    fn passing_inside(&mut self, group: &str, port: Option<&str>) -> Vec<String> {
        let key = (group.to_owned(), port.map(str::to_owned));
        if let Some(known) = self.inside.get(&key) {
            return known.clone();
        }
        if self.depth == DEEPEST {
            return Vec::new();
        }
        self.depth += 1;
        self.inside.insert(key.clone(), Vec::new());
        let body = Body::Group(group.to_owned());
        let (_, outputs) = instances::ports(self.document.contents(), &body);
        let given = match port {
            Some(port) => outputs.get(port),
            None => outputs.values().next(),
        };
        // Those not asked yet, the next one last.
        let mut ways: Vec<Sources> = vec![(None, given.cloned())];
        let mut found: Vec<String> = Vec::new();
        let mut asked = BTreeSet::new();
        while let Some((feeder, wire)) = ways.pop() {
            found.extend(feeder.filter(|input| !found.contains(input)));
            let Some(at) = wire.filter(|at| asked.insert(at.node.clone())) else {
                continue;
            };
            let inputs = self.passing(&body, &at).into_iter().rev();
            ways.extend(inputs.map(|input| self.sources(&body, &at.node, input)));
        }
        self.inside.insert(key, found.clone());
        self.depth -= 1;
        found
    }
}
