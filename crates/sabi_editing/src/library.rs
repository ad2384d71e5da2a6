//! The library: groups saved for use in other graphs, each as a graph file.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sabi_engine::OpenGraph;
use sabi_engine::session::{free_graph_file, relocate_paths};
use sabi_graph::{Body, Document, Edit, GROUP_KIND, GroupDef, Node, NodeId};

use crate::bundled_groups::{as_group, bundled, group_name};
use crate::connections::PendingWire;
use crate::linked_groups::link_to;
use crate::names::free_name;
use crate::open_document::OpenDocument;
use crate::{connections, group_import, new_nodes, nodes};

/// File extension of graph files.
pub const GRAPH_EXTENSION: &str = "sabi";

/// Writes the group of the selected instance into a folder, as a graph file that other graphs can use. Returns the file.
pub fn save_group(document: &mut OpenDocument, folder: &Path) -> Option<PathBuf> {
    let name = document.selected_one().and_then(|id| document.node(id)?.group.clone());
    let Some((name, group)) =
        name.and_then(|name| Some((name.clone(), document.contents().groups.get(&name)?.clone())))
    else {
        document.notify("Select a group to put it into the library; Ctrl+G makes one of the selected nodes.");
        return None;
    };
    let saved = match group_document(document, &name, &group) {
        Ok(saved) => saved,
        Err(why) => {
            document.notify(why);
            return None;
        }
    };
    let text = relocate_paths(&saved, document.session.graph().folder(), folder).to_json();
    match write_group(document, folder, &name, &text) {
        Ok(file) => {
            let called = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
            document.notify(format!("'{name}' is in the library now, as {called}."));
            Some(file)
        }
        Err(why) => {
            document.notify(why);
            None
        }
    }
}

/// Writes a group to a new file. It replaces no existing file, not even one that is created at the same moment.
fn write_group(document: &OpenDocument, folder: &Path, name: &str, text: &str) -> Result<PathBuf, String> {
    let disk = document.session.disk();
    loop {
        let Some(file) = free_graph_file(folder, &file_stem(name), text.as_bytes()) else {
            return Err(format!(
                "{} has too many groups of that name; give this one another",
                folder.display()
            ));
        };
        let is_there = file.exists();
        let written = match is_there {
            // The file has these bytes already. Write it anyway to make sure that they are on the disk.
            true => disk.write_whole(&file, text.as_bytes()),
            false => disk.write_new(&file, text.as_bytes()),
        };
        match written {
            Ok(()) => return Ok(file),
            // Another program has just created the file: try the next free name.
            Err(error) if !is_there && error.kind() == ErrorKind::AlreadyExists && file.exists() => {}
            Err(error) => return Err(format!("{} cannot be written: {}", file.display(), error.reason())),
        }
    }
}

/// A group as a document, with the groups that it contains.
fn group_document(document: &OpenDocument, name: &str, group: &GroupDef) -> Result<Document, String> {
    let mut saved = Document::new(group.name.as_deref().unwrap_or(name));
    saved.description = group.description.clone();
    saved.fit = group.fit.unwrap_or(document.contents().fit);
    let refused = |error: sabi_graph::EditError| format!("'{name}' cannot be a file of its own: {error}");
    let named = group.graph.nodes().filter_map(|(_, node)| node.group.clone());
    let needed = group_import::needed(document.contents(), named);
    for name in group_import::in_order(document.contents(), &needed) {
        let add = Edit::AddGroup {
            group: Box::new(document.contents().groups[&name].clone()),
            name,
        };
        saved.apply(add).map_err(refused)?;
    }
    for id in group.graph.topological_order() {
        if let Some(node) = group.graph.node(id.as_str()).cloned() {
            let add = Edit::AddNode {
                body: Body::Main,
                inputs: connections::wires_from(&group.graph, &id, |_| true),
                id,
                node,
            };
            saved.apply(add).map_err(refused)?;
        }
    }
    for edit in group_import::exposing(&Body::Main, group) {
        saved.apply(edit).map_err(refused)?;
    }
    Ok(saved)
}

/// Adds an instance of a library group; the group is imported into the document.
pub fn add(document: &mut OpenDocument, file: &Path, pos: [f32; 2], pending: Option<&PendingWire>) -> Option<NodeId> {
    let group = import(document, file)?;
    nodes::add_instance(document, &group, pos, pending)
}

/// Imports a library group, unless the document has it already. Returns its name in the document.
pub fn import(document: &mut OpenDocument, file: &Path) -> Option<String> {
    let open = match OpenGraph::open_trusting(file, &document.session.graph().trusted) {
        Ok(open) => open,
        Err(error) => {
            document.notify(error.to_string());
            return None;
        }
    };
    if let Some(known) = group_in(document, &open, file) {
        return Some(known);
    }
    let mut other = match bundled(document, &open, file) {
        Ok(other) => other,
        Err(why) => {
            document.notify(why);
            return None;
        }
    };
    let name = free_name(&group_name(&other, file), ' ', |name| other.groups.contains_key(name));
    let group = GroupDef {
        library: link_to(document, file),
        ..as_group(&other)
    };
    other.groups.insert(name.clone(), group);
    let mut instance = Node::new(GROUP_KIND);
    instance.group = Some(name);
    let (id, _) = new_nodes::of_kind(document, GROUP_KIND, [0.0; 2]);
    let imported = group_import::import_groups(document.contents(), &other, &BTreeMap::from([(id, instance.clone())]));
    imported.rename(&mut instance);
    if !imported.edits.is_empty() && !document.edit("Add a group", imported.edits) {
        return None;
    }
    instance.group
}

/// Returns the group of the document that has the same name and content as a library file, if there is one.
pub fn group_in(document: &OpenDocument, open: &OpenGraph, file: &Path) -> Option<String> {
    let groups = &document.contents().groups;
    let name = group_name(&open.document, file);
    let is_called = |(key, group): &(&String, &GroupDef)| group.name.as_ref().unwrap_or(key) == &name;
    let (key, known) = groups.iter().find(is_called)?;
    let other = bundled(document, open, file).ok()?;
    let mut saved = as_group(&other);
    saved.library.clone_from(&known.library);
    saved.name.clone_from(&known.name);
    // A group without a fit uses the fit of its document.
    let has_same_fit = known.fit.unwrap_or(document.contents().fit) == other.fit;
    saved.fit = known.fit;
    let has_same_inner = other.groups.iter().all(|(name, inner)| groups.get(name) == Some(inner));
    (saved == *known && has_same_fit && has_same_inner).then(|| key.clone())
}

/// Returns a file stem for a name that is valid on every system.
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
