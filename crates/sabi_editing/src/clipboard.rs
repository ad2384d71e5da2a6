//! Nodes as text: a graph file of its own, so that it can be mailed, kept and read.

use std::collections::BTreeMap;

use sabi_engine::{canonical, path_from_stored, stored_path};
use sabi_graph::{Body, Document, Edit, Node, NodeId, Value};

use super::duplication::frames_around;
use super::group_import::Brought;
use super::{OpenDocument, group_import};

/// Key of the folder that the paths of a copy begin at.
const FROM: &str = "folder";

impl OpenDocument {
    /// The selected nodes as the text of a graph file, with the groups that they are instances of and the frames around
    /// them; none where nothing is selected. The text
    /// says from which folder its paths lead on, so that they lead to the same from other graphs.
    pub fn copied(&self) -> Option<String> {
        if self.selection.is_empty() {
            return None;
        }
        let mut copy = Document::new("");
        let named = self.selection.iter().filter_map(|id| self.node(id)?.group.clone());
        let needed = group_import::needed(self.contents(), named);
        // A group can be added once those inside it are there: they come first.
        for name in group_import::in_order(self.contents(), &needed) {
            copy.apply(Edit::AddGroup {
                group: Box::new(self.contents().groups[&name].clone()),
                name,
            })
            .ok()?;
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
        for (id, frame) in frames_around(self.graph(), |id| self.selection.contains(id)) {
            let body = Body::Main;
            copy.apply(Edit::AddFrame { body, id, frame }).ok()?;
        }
        if let Ok(folder) = canonical(self.session.graph().folder()) {
            copy.extra.insert(FROM.to_owned(), Value::Text(stored_path(&folder)));
        }
        Some(copy.to_json())
    }

    /// A copied document with paths that lead from here to where they led from there. Those of a folder that is not there, as on
    /// another machine, stay as they are.
    fn brought_here(&self, document: Document) -> Document {
        let from = document
            .extra
            .get(FROM)
            .and_then(Value::as_text)
            .and_then(path_from_stored);
        match from.filter(|from| from.is_dir()) {
            Some(from) => self.moved_here(&document, &from),
            None => document,
        }
    }

    /// Cuts the selected nodes: what [`OpenDocument::copied`] gives, and they are gone.
    pub fn cut_out(&mut self) -> Option<String> {
        let text = self.copied()?;
        self.delete(false).then_some(text)
    }

    /// Adds what a text holds, with its upper left corner at a place on the canvas.
    pub fn paste(&mut self, text: &str, pos: [f32; 2]) -> bool {
        let document = match Document::from_json(text) {
            Ok(document) if !document.graph.is_empty() => self.brought_here(document),
            Ok(_) => return self.refuse("the clipboard holds a graph without nodes"),
            Err(_) => return self.refuse("the clipboard holds no nodes; copy some first"),
        };
        let mut nodes: BTreeMap<NodeId, Node> = document
            .graph
            .nodes()
            .map(|(id, node)| (id.clone(), node.clone()))
            .collect();
        let brought = self.brought_groups(&document, &nodes);
        for node in nodes.values_mut() {
            brought.rename(node);
        }
        if let Some((name, open)) = self.first_that_holds_the_open(&nodes, &brought) {
            let why = format!("'{name}' holds '{open}', which is open here; a group cannot be inside itself");
            return self.refuse(why);
        }
        let corner = nodes.values().fold([f32::INFINITY; 2], |corner, node| {
            [corner[0].min(node.pos[0]), corner[1].min(node.pos[1])]
        });
        let offset = [0, 1].map(|axis| (pos[axis] - corner[axis]).round());
        let frames = frames_around(&document.graph, |_| true);
        let copies = self.copies(&nodes, frames, false, offset);
        self.add_all("Paste", brought.edits, copies)
    }

    /// A group without which these nodes would not be what they are and that holds the one that is seen, with its name. Of
    /// what is brought, only groups that are here already can.
    fn first_that_holds_the_open(&self, nodes: &BTreeMap<NodeId, Node>, brought: &Brought) -> Option<(String, String)> {
        let named = nodes.values().filter_map(|node| node.group.as_deref());
        let mut names = named.chain(brought.used());
        names.find_map(|name| Some((name.to_owned(), self.would_hold_itself(name)?)))
    }
}
