//! The clipboard: nodes as the text of a graph file.

use std::collections::BTreeMap;

use sabi_files::{canonical, path_from_stored, stored_path};
use sabi_graph::{Body, Document, Edit, Node, NodeId, Value};

use crate::duplication::frames_around;
use crate::group_import::ImportedGroups;
use crate::open_document::OpenDocument;
use crate::painting::{PAINT, STROKES as STROKES_OF_NODE};
use crate::{connections, duplication, group_import, nodes, relative_paths};

/// Key for the folder to which the relative paths of a copy refer.
const FROM: &str = "folder";

/// Key for the file beside which the strokes of copied paint nodes are stored.
const STROKES: &str = "strokes_beside";

/// Returns the text of a graph file with the selected nodes, the groups that they use, and the frames around them; `None`
/// if nothing is selected. The text also names the folder to which its relative paths refer, so that paste can convert
/// them, and the file beside which its strokes are stored.
pub fn copy(document: &OpenDocument) -> Option<String> {
    if document.selection().is_empty() {
        return None;
    }
    let mut copy = Document::new("");
    let named = document
        .selection()
        .iter()
        .filter_map(|id| document.node(id)?.group.clone());
    let needed = group_import::needed(document.contents(), named);
    // A group can be added only after the groups inside it, so those come first.
    for name in group_import::in_order(document.contents(), &needed) {
        copy.apply(Edit::AddGroup {
            group: Box::new(document.contents().groups[&name].clone()),
            name,
        })
        .ok()?;
    }
    let ids = document.graph().topological_order();
    for id in ids.iter().filter(|id| document.selection().contains(*id)) {
        let add = Edit::AddNode {
            body: Body::Main,
            id: id.clone(),
            node: document.node(id)?.clone(),
            inputs: connections::wires_from(document.graph(), id, |from| document.selection().contains(from)),
        };
        copy.apply(add).ok()?;
    }
    for (id, frame) in frames_around(document.graph(), |id| document.selection().contains(id)) {
        let body = Body::Main;
        copy.apply(Edit::AddFrame { body, id, frame }).ok()?;
    }
    if let Ok(folder) = canonical(document.session.graph().folder()) {
        copy.extra.insert(FROM.to_owned(), Value::Text(stored_path(&folder)));
    }
    let place = document.session.stroke_place().filter(|_| has_strokes(&copy));
    if let Some(place) = place.and_then(|place| canonical(&place).ok()) {
        copy.extra.insert(STROKES.to_owned(), Value::Text(stored_path(&place)));
    }
    Some(copy.to_json())
}

/// Returns true if a paint node in the graph or in one of its groups has strokes.
fn has_strokes(copy: &Document) -> bool {
    let groups = copy.groups.values().map(|group| &group.graph);
    let mut nodes = std::iter::once(&copy.graph)
        .chain(groups)
        .flat_map(|graph| graph.nodes());
    nodes.any(|(_, node)| node.kind == PAINT && node.params.contains_key(STROKES_OF_NODE))
}

/// Returns the copied document with its paths converted to the folder of this document. Paths stay unchanged if their
/// folder does not exist, for example after copying from another computer.
fn with_paths_from_here(document: &OpenDocument, copied: Document) -> Document {
    let from = copied
        .extra
        .get(FROM)
        .and_then(Value::as_text)
        .and_then(path_from_stored);
    match from.filter(|from| from.is_dir()) {
        Some(from) => relative_paths::relocated(document, &copied, &from),
        None => copied,
    }
}

/// Returns the selected nodes as text for the clipboard, as [`copy()`] does, and removes them.
pub fn cut(document: &mut OpenDocument) -> Option<String> {
    let text = copy(document)?;
    nodes::delete(document, false).then_some(text)
}

/// Adds the nodes of a text, with their upper left corner at a place on the canvas.
pub fn paste(document: &mut OpenDocument, text: &str, pos: [f32; 2]) -> bool {
    let copied = match Document::from_json(text) {
        Ok(copied) if !copied.graph.is_empty() => with_paths_from_here(document, copied),
        Ok(_) => return document.refuse("the clipboard holds a graph without nodes"),
        Err(_) => return document.refuse("the clipboard holds no nodes; copy some first"),
    };
    let mut nodes: BTreeMap<NodeId, Node> = copied
        .graph
        .nodes()
        .map(|(id, node)| (id.clone(), node.clone()))
        .collect();
    let imported = group_import::import_groups(document.contents(), &copied, &nodes);
    for node in nodes.values_mut() {
        imported.rename(node);
    }
    if let Some((name, open)) = first_containing_shown(document, &nodes, &imported) {
        let why = format!("'{name}' holds '{open}', which is open here; a group cannot be inside itself");
        return document.refuse(why);
    }
    let corner = nodes.values().fold([f32::INFINITY; 2], |corner, node| {
        [corner[0].min(node.pos[0]), corner[1].min(node.pos[1])]
    });
    let offset = [0, 1].map(|axis| (pos[axis] - corner[axis]).round());
    let frames = frames_around(&copied.graph, |_| true);
    let wires = duplication::wires_between(&copied.graph, &nodes, false);
    let copies = duplication::copies(document, &nodes, wires, frames, offset);
    let is_added = duplication::add_all(document, "Paste", imported.edits, copies);
    let place = copied
        .extra
        .get(STROKES)
        .and_then(Value::as_text)
        .and_then(path_from_stored);
    if let Some(place) = place.filter(|_| is_added) {
        // If the disk refuses this, it is reported with the next stroke, or when the graph is saved.
        let _ = document.session.take_strokes_beside(&place);
    }
    is_added
}

/// Returns the first group that these nodes use and that contains the shown group, with the name of the shown group. Of
/// imported groups, only groups that this document already had can contain the shown group.
fn first_containing_shown(
    document: &OpenDocument,
    nodes: &BTreeMap<NodeId, Node>,
    imported: &ImportedGroups,
) -> Option<(String, String)> {
    let named = nodes.values().filter_map(|node| node.group.as_deref());
    let mut names = named.chain(imported.used());
    names.find_map(|name| Some((name.to_owned(), nodes::containing_shown(document, name)?)))
}
