//! Groups: going in and out, and what they are called.

use sabi_graph::{Body, Edit, GROUP_KIND, NodeId};

use super::Desk;
use super::nodes::is_file;

/// The sentence that a group is not part of the document.
pub(super) fn of_its_own(group: &str) -> String {
    format!("'{group}' is a file of its own; open it to change what is inside")
}

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

    /// What the graph that is seen is called: the document's name, or the group's.
    pub(crate) fn graph_title(&self) -> String {
        match &self.seen {
            Body::Main if self.document().name.is_empty() => "Untitled".to_owned(),
            Body::Main => self.document().name.clone(),
            Body::Group(name) => self.group_title(name),
        }
    }

    fn group_title(&self, name: &str) -> String {
        let group = self.document().groups.get(name);
        group
            .and_then(|group| group.name.clone())
            .unwrap_or_else(|| name.to_owned())
    }

    /// Goes into a group instance.
    pub(crate) fn enter(&mut self, id: &NodeId) -> bool {
        let instance = self.node(id).filter(|node| node.kind == GROUP_KIND);
        let Some(group) = instance.and_then(|node| node.group.clone()) else {
            return false;
        };
        if !self.document().groups.contains_key(&group) {
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
    pub(crate) fn leave_to(&mut self, depth: usize) -> bool {
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
    pub(crate) fn leave(&mut self) -> bool {
        match self.inside.len() {
            0 => false,
            depth => self.leave_to(depth - 1),
        }
    }

    /// Gives a group another name, under which all its instances find it.
    pub(crate) fn rename_group(&mut self, name: &str, to: &str) -> bool {
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
        free_name(stem, ' ', |name| self.document().groups.contains_key(name))
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
