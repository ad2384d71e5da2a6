//! Groups of another document, brought into this one. One that is here already with the same content is used; one that only
//! has the same name gets another.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Document, Edit, Frame, GROUP_KIND, GroupDef, Node, NodeId};

use crate::open_document::OpenDocument;

/// What has to be done so that another document's groups are here.
pub(crate) struct Brought {
    pub(crate) edits: Vec<Edit>,
    /// The name here of each group that was needed.
    names: BTreeMap<String, String>,
    /// Groups that were here already.
    used: BTreeSet<String>,
}

impl Brought {
    /// Has an instance name its group as it is called here.
    pub(crate) fn rename(&self, node: &mut Node) {
        if let Some(new) = group_of(node).and_then(|name| self.names.get(name)) {
            node.group = Some(new.clone());
        }
    }

    /// Groups that are here already and are used by what is brought.
    pub(crate) fn used(&self) -> impl Iterator<Item = &str> {
        self.used.iter().map(String::as_str)
    }
}

/// The group that a node is an instance of.
fn group_of(node: &Node) -> Option<&String> {
    node.group.as_ref().filter(|_| node.kind == GROUP_KIND)
}

/// The groups of a document that these need, and they themselves.
pub(crate) fn needed(document: &Document, names: impl IntoIterator<Item = String>) -> BTreeSet<String> {
    let mut needed = BTreeSet::new();
    let mut next: Vec<String> = names.into_iter().collect();
    while let Some(name) = next.pop() {
        let Some(group) = document.groups.get(&name) else {
            continue;
        };
        if needed.insert(name) {
            next.extend(group.graph.nodes().filter_map(|(_, node)| group_of(node).cloned()));
        }
    }
    needed
}

/// Some of a document's groups, each after those that it needs. Groups that hold themselves, which no evaluation takes, are
/// left out, and what needs them is as well.
pub(crate) fn in_order(document: &Document, some: &BTreeSet<String>) -> Vec<String> {
    let mut ordered: Vec<String> = Vec::new();
    let mut rest: Vec<&String> = some.iter().collect();
    loop {
        let before = rest.len();
        rest.retain(|name| {
            let nodes = document.groups[*name].graph.nodes();
            let mut needed = nodes.filter_map(|(_, node)| group_of(node));
            let is_ready = needed.all(|needed| ordered.contains(needed) || !some.contains(needed));
            if is_ready {
                ordered.push((*name).clone());
            }
            !is_ready
        });
        if rest.len() == before {
            return ordered;
        }
    }
}

/// What it takes to have the groups here that nodes of another document need.
pub(crate) fn import_groups(document: &OpenDocument, other: &Document, nodes: &BTreeMap<NodeId, Node>) -> Brought {
    let mut brought = Brought {
        edits: Vec::new(),
        names: BTreeMap::new(),
        used: BTreeSet::new(),
    };
    let needed = needed(other, nodes.values().filter_map(|node| group_of(node).cloned()));
    // As this document is once those before are in it.
    let mut here = document.contents().clone();
    for name in in_order(other, &needed) {
        let edits = |free: &str| group_edits(free, &other.groups[&name], &brought);
        let numbered = (2..).map(|number| format!("{name} {number}"));
        for candidate in std::iter::once(name.clone()).chain(numbered) {
            let mut made = here.clone();
            if let Some(known) = made.groups.remove(&candidate) {
                let is_same =
                    made.apply(Edit::Batch(edits(&candidate))).is_ok() && made.groups.get(&candidate) == Some(&known);
                if !is_same {
                    continue;
                }
                brought.used.insert(candidate.clone());
            } else {
                let edits = edits(&candidate);
                if made.apply(Edit::Batch(edits.clone())).is_err() {
                    break;
                }
                brought.edits.extend(edits);
                here = made;
            }
            brought.names.insert(name.clone(), candidate);
            break;
        }
    }
    brought
}

/// The edits that define a group whose inner groups may have other names here.
fn group_edits(name: &str, group: &GroupDef, brought: &Brought) -> Vec<Edit> {
    let body = Body::Group(name.to_owned());
    let mut edits = vec![Edit::AddGroup {
        name: name.to_owned(),
        group: Box::new(GroupDef {
            name: group.name.clone(),
            fit: group.fit,
            extra: group.extra.clone(),
            ..GroupDef::default()
        }),
    }];
    for id in group.graph.topological_order() {
        let Some(mut node) = group.graph.node(id.as_str()).cloned() else {
            continue;
        };
        brought.rename(&mut node);
        let body = body.clone();
        edits.push(Edit::AddNode { body, id, node });
    }
    edits.extend(publishing(&body, group));
    edits
}

/// The edits that publish what a definition of a group publishes, and its frames.
pub(crate) fn publishing(body: &Body, group: &GroupDef) -> Vec<Edit> {
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
    let frames = group.graph.frames().iter();
    let frames = frames.map(|(id, frame): (&String, &Frame)| Edit::AddFrame {
        body: body.clone(),
        id: id.clone(),
        frame: frame.clone(),
    });
    let around = knobs.chain(variants).chain(frames);
    inputs.chain(outputs).chain(around).collect()
}
