//! Groups that are kept to be used in other graphs: each a graph file of its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_engine::{OpenGraph, canonical, free_graph_file, moved_to, with_whole_paths, write_whole};
use sabi_graph::{Body, Document, Edit, GROUP_KIND, GroupDef, Node, NodeId};

use super::{OpenDocument, PendingWire, group_import};

/// What graph files end in.
pub const GRAPH_EXTENSION: &str = "sabi";

impl OpenDocument {
    /// Writes the group of the selected instance into a folder, as a graph file that other graphs can use.
    pub fn shelve(&mut self, folder: &Path) -> Option<PathBuf> {
        let name = self.selected_one().and_then(|id| self.node(id)?.group.clone());
        let Some((name, group)) =
            name.and_then(|name| Some((name.clone(), self.contents().groups.get(&name)?.clone())))
        else {
            self.say("Select a group to put it into the library; Ctrl+G makes one of the selected nodes.");
            return None;
        };
        let document = match self.as_document(&name, &group) {
            Ok(document) => document,
            Err(why) => {
                self.say(why);
                return None;
            }
        };
        let text = moved_to(&document, self.session.graph().folder(), folder).to_json();
        let Some(file) = free_graph_file(folder, &file_stem(&name), text.as_bytes()) else {
            self.say(format!(
                "{} has too many groups of that name; give this one another",
                folder.display()
            ));
            return None;
        };
        match write_whole(&file, text.as_bytes()) {
            Ok(()) => {
                let called = file.file_name().unwrap_or_default().to_string_lossy();
                self.say(format!("'{name}' is in the library now, as {called}."));
                Some(file)
            }
            Err(error) => {
                self.say(format!("{} cannot be written: {}", file.display(), error.reason()));
                None
            }
        }
    }

    /// A document of another folder as this graph can take it over: its paths lead where they led. Before a graph has a file
    /// there is no folder that they could begin at.
    pub(super) fn moved_here(&self, document: &Document, from: &Path) -> Document {
        let here = self.session.graph().folder();
        let is_same = canonical(from).ok() == canonical(here).ok();
        match self.session.file() {
            Some(_) => moved_to(document, from, here),
            None if is_same => document.clone(),
            None => with_whole_paths(document, from),
        }
    }

    /// A group as a document of its own, with the groups that it needs.
    fn as_document(&self, name: &str, group: &GroupDef) -> Result<Document, String> {
        let mut document = Document::new(group.name.as_deref().unwrap_or(name));
        document.fit = group.fit.unwrap_or(self.contents().fit);
        let refused = |error: sabi_graph::EditError| format!("'{name}' cannot be a file of its own: {error}");
        let named = group.graph.nodes().filter_map(|(_, node)| node.group.clone());
        let needed = group_import::needed(self.contents(), named);
        for name in group_import::in_order(self.contents(), &needed) {
            let add = Edit::AddGroup {
                group: Box::new(self.contents().groups[&name].clone()),
                name,
            };
            document.apply(add).map_err(refused)?;
        }
        for id in group.graph.topological_order() {
            if let Some(node) = group.graph.node(id.as_str()).cloned() {
                let add = Edit::AddNode {
                    body: Body::Main,
                    id,
                    node,
                };
                document.apply(add).map_err(refused)?;
            }
        }
        for edit in group_import::publishing(&Body::Main, group) {
            document.apply(edit).map_err(refused)?;
        }
        Ok(document)
    }

    /// Adds an instance of a group out of the library; the group becomes one of the document's own.
    pub fn add_from_library(&mut self, file: &Path, pos: [f32; 2], loose: Option<&PendingWire>) -> Option<NodeId> {
        let group = self.bring_from_library(file)?;
        self.add_group_instance(&group, pos, loose)
    }

    /// Makes a group of the library one of the document's own, if it is not one already; gives its name here.
    pub fn bring_from_library(&mut self, file: &Path) -> Option<String> {
        let open = match OpenGraph::open(file) {
            Ok(open) => open,
            Err(error) => {
                self.say(error.to_string());
                return None;
            }
        };
        let mut document = self.moved_here(&open.document, open.folder());
        let stem = file
            .file_stem()
            .map_or_else(|| "Group".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let name = if document.name.is_empty() {
            stem
        } else {
            document.name.clone()
        };
        let group = GroupDef {
            name: None,
            fit: Some(document.fit),
            graph: document.graph.clone(),
            inputs: document.inputs.clone(),
            outputs: document.outputs.clone(),
            ..GroupDef::default()
        };
        document.groups.insert(name.clone(), group);
        let mut instance = Node::new(GROUP_KIND);
        instance.group = Some(name);
        let (id, _) = self.fresh(GROUP_KIND, [0.0; 2]);
        let brought = self.brought_groups(&document, &BTreeMap::from([(id, instance.clone())]));
        brought.rename(&mut instance);
        if !brought.edits.is_empty() && !self.edit("Add a group", brought.edits) {
            return None;
        }
        instance.group
    }
}

/// A name as files are called on every system.
fn file_stem(name: &str) -> String {
    let kept = name.chars().map(|letter| {
        if letter.is_alphanumeric() || letter == '-' {
            letter
        } else {
            '_'
        }
    });
    let stem: String = kept.collect();
    if stem.trim_matches('_').is_empty() {
        "group".to_owned()
    } else {
        stem.to_lowercase()
    }
}
