//! Groups: going in and out, and what they are called.

use std::sync::Arc;

use sabi_engine::catalog::{Entry, Faces};
use sabi_graph::{Body, Edit, GROUP_KIND, NodeId};

use super::OpenDocument;
use super::nodes::is_file;

/// The sentence that a group is not part of the document.
pub(super) fn of_its_own(group: &str) -> String {
    format!("'{group}' is a file of its own; open it to change what is inside")
}

impl OpenDocument {
    /// Instances that were entered, outermost first, each with what it is called: the path that a breadcrumb shows.
    pub fn path(&self) -> Vec<(NodeId, String)> {
        let bodies = self.bodies();
        let steps = self.inside.iter().zip(&bodies);
        let title = |(id, body): (&NodeId, &Body)| {
            let node = self.graph_of(body).and_then(|graph| graph.node(id.as_str()));
            let label = node.and_then(|node| node.label.clone().or_else(|| node.group.clone()));
            (id.clone(), label.unwrap_or_else(|| id.to_string()))
        };
        steps.take(bodies.len() - 1).map(title).collect()
    }

    /// What the graph that is seen is called: the document's name, or the group's. Documents may have none.
    pub fn graph_name(&self) -> String {
        match &self.seen {
            Body::Main => self.contents().name.clone(),
            Body::Group(name) => {
                let group = self.contents().groups.get(name);
                group
                    .and_then(|group| group.name.clone())
                    .unwrap_or_else(|| name.clone())
            }
        }
    }

    /// IdGenerator the graph that is seen.
    pub fn rename_graph(&mut self, to: &str) -> bool {
        match self.body() {
            Body::Main => {
                let name = to.trim().to_owned();
                self.edit("Rename graph", vec![Edit::RenameDocument { name }])
            }
            Body::Group(name) => self.rename_group(&name, to),
        }
    }

    /// What those see of the graph that is seen who use it as a group.
    pub fn own_face(&self) -> Option<&Arc<Entry>> {
        face_of(self.faces(), &self.seen)
    }

    /// Goes into a group instance.
    pub fn enter(&mut self, id: &NodeId) -> bool {
        let instance = self.node(id).filter(|node| node.kind == GROUP_KIND);
        let Some(group) = instance.and_then(|node| node.group.clone()) else {
            return false;
        };
        if !self.contents().groups.contains_key(&group) {
            return self.refuse(of_its_own(&group));
        }
        // A file may have a group that holds itself; nobody gets to its bottom.
        if self.bodies().contains(&Body::Group(group.clone())) {
            return self.refuse(format!("'{group}' holds itself; take this instance of it away"));
        }
        self.inside.push(id.clone());
        self.look();
        self.selection.clear();
        true
    }

    /// Goes so many steps up at least; the instance that was left is selected.
    pub fn leave_to(&mut self, depth: usize) -> bool {
        let left = self.inside.get(depth).cloned();
        self.inside.truncate(depth);
        self.look();
        let has_left = left.is_some();
        if let Some(left) = left {
            self.select([left]);
        }
        has_left
    }

    /// Goes one step up.
    pub fn leave(&mut self) -> bool {
        match self.inside.len() {
            0 => false,
            depth => self.leave_to(depth - 1),
        }
    }

    /// Gives a group another name, under which all its instances find it.
    pub fn rename_group(&mut self, name: &str, to: &str) -> bool {
        let to = to.trim();
        if is_file(to) {
            return self.refuse(format!(
                "'{to}' is the name of a file; choose one that does not end in .sabi"
            ));
        }
        let edit = Edit::RenameGroup {
            name: name.to_owned(),
            to: to.to_owned(),
            shown: None,
        };
        self.edit("Rename group", vec![edit])
    }

    /// A name that no group has.
    pub(super) fn free_group_name(&self, stem: &str) -> String {
        free_name(stem, ' ', |name| self.contents().groups.contains_key(name))
    }
}

/// What those see of a graph who use it as a group.
pub(super) fn face_of<'f>(faces: &'f Faces, body: &Body) -> Option<&'f Arc<Entry>> {
    match body {
        Body::Main => faces.of_whole(),
        Body::Group(name) => faces.of_group(name),
    }
}

/// A name that is not taken: the stem, or the stem with a number.
pub(super) fn free_name(stem: &str, before_number: char, is_taken: impl Fn(&str) -> bool) -> String {
    let mut name = stem.to_owned();
    let mut number = 2;
    while is_taken(&name) {
        name = format!("{stem}{before_number}{number}");
        number += 1;
    }
    name
}
