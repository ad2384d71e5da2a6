//! Import of groups from another document. A group that exists here with the same content is reused. If only the name is
//! the same, the group is imported under another name.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Body, Document, Edit, Frame, GROUP_KIND, GroupDef, Node, NodeId};

use crate::connections;

/// Edits that import groups of another document, and the names of these groups in this document.
pub(crate) struct ImportedGroups {
    pub(crate) edits: Vec<Edit>,
    /// Name in this document of each imported group, by its name in the other document.
    names: BTreeMap<String, String>,
    /// Groups that existed in this document already.
    used: BTreeSet<String>,
}

impl ImportedGroups {
    /// Sets the group of an instance to its name in this document.
    pub(crate) fn rename(&self, node: &mut Node) {
        if let Some(new) = group_of(node).and_then(|name| self.names.get(name)) {
            node.group = Some(new.clone());
        }
    }

    /// Name in this document of a group of the other document.
    pub(crate) fn name(&self, group: &str) -> Option<&String> {
        self.names.get(group)
    }

    /// Groups that existed in this document already and that the imported nodes use.
    pub(crate) fn used(&self) -> impl Iterator<Item = &str> {
        self.used.iter().map(String::as_str)
    }
}

/// Name of the group that a node is an instance of.
fn group_of(node: &Node) -> Option<&String> {
    node.group.as_ref().filter(|_| node.kind == GROUP_KIND)
}

/// Returns the groups with these names and all groups inside them, if the document has them.
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

/// Sorts some of a document's groups so that each comes after the groups that it contains. Groups that contain themselves
/// cannot be evaluated and are left out, together with the groups that contain them.
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

/// Returns the edits that add the groups that nodes of another document need, and the names of these groups in this document.
pub(crate) fn import_groups(document: &Document, other: &Document, nodes: &BTreeMap<NodeId, Node>) -> ImportedGroups {
    let mut imported = ImportedGroups {
        edits: Vec::new(),
        names: BTreeMap::new(),
        used: BTreeSet::new(),
    };
    let needed = needed(other, nodes.values().filter_map(|node| group_of(node).cloned()));
    // A copy of this document to which the groups imported so far are added.
    let mut here = document.clone();
    for name in in_order(other, &needed) {
        let edits = |free: &str| group_edits(free, &other.groups[&name], &imported);
        let numbered = (2..).map(|number| format!("{name} {number}"));
        for candidate in std::iter::once(name.clone()).chain(numbered) {
            let mut made = here.clone();
            if let Some(known) = made.groups.remove(&candidate) {
                let is_same =
                    made.apply(Edit::Batch(edits(&candidate))).is_ok() && made.groups.get(&candidate) == Some(&known);
                if !is_same {
                    continue;
                }
                imported.used.insert(candidate.clone());
            } else {
                let edits = edits(&candidate);
                if made.apply(Edit::Batch(edits.clone())).is_err() {
                    break;
                }
                imported.edits.extend(edits);
                here = made;
            }
            imported.names.insert(name.clone(), candidate);
            break;
        }
    }
    imported
}

/// Edits that define a group whose inner groups may have other names in this document.
fn group_edits(name: &str, group: &GroupDef, imported: &ImportedGroups) -> Vec<Edit> {
    let body = Body::Group(name.to_owned());
    let mut edits = vec![Edit::AddGroup {
        name: name.to_owned(),
        group: Box::new(GroupDef {
            name: group.name.clone(),
            description: group.description.clone(),
            library: group.library.clone(),
            fit: group.fit,
            extra: group.extra.clone(),
            ..GroupDef::default()
        }),
    }];
    for id in group.graph.topological_order() {
        let Some(mut node) = group.graph.node(id.as_str()).cloned() else {
            continue;
        };
        imported.rename(&mut node);
        edits.push(Edit::AddNode {
            body: body.clone(),
            inputs: connections::wires_from(&group.graph, &id, |_| true),
            id,
            node,
        });
    }
    edits.extend(exposing(&body, group));
    edits
}

/// Edits that add the exposed ports and knobs, the variants, the frames and the notes of a group definition.
pub(crate) fn exposing(body: &Body, group: &GroupDef) -> Vec<Edit> {
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
    let notes = group.graph.notes().iter().map(|(id, note)| Edit::SetNote {
        body: body.clone(),
        id: id.clone(),
        note: Some(note.clone()),
    });
    inputs
        .chain(outputs)
        .chain(knobs)
        .chain(variants)
        .chain(frames)
        .chain(notes)
        .collect()
}
