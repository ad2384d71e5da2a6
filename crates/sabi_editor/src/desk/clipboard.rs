//! Nodes as text: a graph file of its own, so that it can be mailed, kept and read.

use std::collections::BTreeMap;

use sabi_graph::{Body, Document, Edit, GroupDef, Node, NodeId};

use super::Desk;

impl Desk {
    /// The selected nodes as the text of a graph file, with the groups that they are instances of.
    pub(crate) fn copied(&self) -> Option<String> {
        if self.selection.is_empty() {
            return None;
        }
        let mut copy = Document::new("");
        for (name, group) in self.groups_of_selection() {
            // A group can be added once those inside it are there: they come first.
            put_group(&mut copy, name, &group);
        }
        let ids = self.graph().topological_order();
        for id in ids.iter().filter(|id| self.selection.contains(*id)) {
            let mut node = self.node(id)?.clone();
            node.inputs.retain(|_, from| self.selection.contains(&from.node));
            let add = Edit::AddNode {
                body: Body::Main,
                id: id.clone(),
                node,
            };
            copy.apply(add).ok()?;
        }
        Some(copy.to_json())
    }

    /// Groups that selected nodes need, each after those that it needs itself.
    fn groups_of_selection(&self) -> Vec<(String, GroupDef)> {
        let document = self.document();
        let mut found: Vec<(String, GroupDef)> = Vec::new();
        let of_node = |node: &Node| node.group.clone().filter(|name| document.groups.contains_key(name));
        let mut open: Vec<String> = self.selection.iter().filter_map(|id| of_node(self.node(id)?)).collect();
        while let Some(name) = open.pop() {
            let Some(group) = document.groups.get(&name) else {
                continue;
            };
            // Found again deeper: it moves behind those that were found since, and so in front after the turn.
            found.retain(|(known, _)| *known != name);
            found.push((name, group.clone()));
            open.extend(group.graph.nodes().filter_map(|(_, node)| of_node(node)));
        }
        found.reverse();
        found
    }

    /// Adds what a text holds, with its upper left corner at a place on the canvas.
    pub(crate) fn paste(&mut self, text: &str, pos: [f32; 2]) -> bool {
        let document = match Document::from_json(text) {
            Ok(document) if !document.graph.is_empty() => document,
            Ok(_) => {
                self.say("the clipboard holds a graph without nodes");
                return false;
            }
            Err(_) => {
                self.say("the clipboard holds no nodes; copy some first");
                return false;
            }
        };
        let mut nodes: BTreeMap<NodeId, Node> = document
            .graph
            .nodes()
            .map(|(id, node)| (id.clone(), node.clone()))
            .collect();
        let mut edits = self.take_groups(&document, &mut nodes);
        let corner = nodes.values().fold([f32::INFINITY; 2], |corner, node| {
            [corner[0].min(node.pos[0]), corner[1].min(node.pos[1])]
        });
        let offset = [0, 1].map(|axis| (pos[axis] - corner[axis]).round());
        let copies = self.copies(&nodes, false, offset);
        let ids: Vec<NodeId> = copies.iter().map(|(id, _)| id.clone()).collect();
        edits.extend(self.adding_all(copies));
        let is_made = self.edit("Paste", edits);
        if is_made {
            self.select(ids);
        }
        is_made
    }

    /// The edits that bring another document's groups here. One that is here already with the same content is used; one
    /// that only has the same name gets another.
    pub(super) fn take_groups(&self, document: &Document, nodes: &mut BTreeMap<NodeId, Node>) -> Vec<Edit> {
        let mut edits = Vec::new();
        let mut names: BTreeMap<String, String> = BTreeMap::new();
        for name in in_order(document) {
            let group = &document.groups[&name];
            let known = self.document().groups.get(&name);
            if known == Some(group) && names.is_empty() {
                continue;
            }
            let is_free = |name: &str| !self.document().groups.contains_key(name);
            let numbered = (2..).map(|number| format!("{name} {number}"));
            let free = std::iter::once(name.clone()).chain(numbered).find(|name| is_free(name));
            let Some(free) = free else { continue };
            edits.extend(group_edits(&free, group, &names));
            if free != name {
                names.insert(name, free);
            }
        }
        for node in nodes.values_mut() {
            if let Some(new) = node.group.as_ref().and_then(|name| names.get(name)) {
                node.group = Some(new.clone());
            }
        }
        edits
    }
}

/// Names of a document's groups, each after those that it needs.
fn in_order(document: &Document) -> Vec<String> {
    let mut ordered: Vec<String> = Vec::new();
    let mut rest: Vec<&String> = document.groups.keys().collect();
    while !rest.is_empty() {
        let before = rest.len();
        rest.retain(|name| {
            let nodes = document.groups[*name].graph.nodes();
            let mut needed = nodes.filter_map(|(_, node)| node.group.as_ref());
            let is_ready = needed.all(|needed| ordered.contains(needed) || !document.groups.contains_key(needed));
            if is_ready {
                ordered.push((*name).clone());
            }
            !is_ready
        });
        if rest.len() == before {
            // Groups inside themselves, which no file that was read has.
            break;
        }
    }
    ordered
}

/// The edits that define a group whose inner groups may have other names here.
fn group_edits(name: &str, group: &GroupDef, renamed: &BTreeMap<String, String>) -> Vec<Edit> {
    if renamed.is_empty() {
        return vec![Edit::AddGroup {
            name: name.to_owned(),
            group: Box::new(group.clone()),
        }];
    }
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
        if let Some(new) = node.group.as_ref().and_then(|name| renamed.get(name)) {
            node.group = Some(new.clone());
        }
        edits.push(Edit::AddNode {
            body: body.clone(),
            id,
            node,
        });
    }
    edits.extend(super::groups::publishing(&body, group));
    edits
}

fn put_group(copy: &mut Document, name: String, group: &GroupDef) {
    let add = Edit::AddGroup {
        name,
        group: Box::new(group.clone()),
    };
    // Those it needs are there, so that nothing keeps it out.
    let added = copy.apply(add);
    debug_assert!(added.is_ok(), "{added:?}");
}
