//! Values of group instances, checked without flattening the graph.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::definitions::resolve;
use super::knobs;
use crate::validate::is_group_file;
use crate::{Document, GROUP_KIND, Graph, NodeId, Value};

/// Most instances that values are followed into.
const MOST_INSTANCES: usize = 64;

/// Reads a group file by its path relative to the document; none if it cannot be read.
pub type ReadShared<'a> = &'a mut dyn FnMut(&str) -> Option<Arc<Document>>;

/// File that an instance is in.
#[derive(Clone)]
enum InstanceFile {
    /// The document itself.
    Own,
    /// A group file, with its path relative to the document.
    Group(String, Arc<Document>),
}

impl InstanceFile {
    fn document<'d>(&'d self, own: &'d Document) -> &'d Document {
        match self {
            InstanceFile::Own => own,
            InstanceFile::Group(_, document) => document,
        }
    }

    /// The file that defines the group of an instance in this file, and whether the group is one within it; otherwise it is the
    /// whole file.
    fn defining(&self, own: &Document, group: &str, read: ReadShared<'_>) -> Option<(InstanceFile, bool)> {
        if self.document(own).groups.contains_key(group) {
            return Some((self.clone(), true));
        }
        let base = match self {
            InstanceFile::Own => "",
            InstanceFile::Group(path, _) => path,
        };
        let path = Some(resolve(base, group)).filter(|_| is_group_file(group))?;
        let document = read(&path)?;
        Some((InstanceFile::Group(path, document), false))
    }
}

/// Returns true if a group takes these parameters of an instance in the document, and so do the instances inside it that its
/// knobs set. A graph that can be flattened can then be flattened with these parameters, too. It clones no graph, so that a
/// slider can ask at each move. `read` reads a group file by its path relative to the document.
///
/// False says only that [`flatten`](super::flatten) has to decide: also for instances with a scale, whose product is limited,
/// and beyond 64 instances.
pub fn takes_values(
    document: &Document,
    group: &str,
    params: &BTreeMap<String, Value>,
    read: &mut dyn FnMut(&str) -> Option<Arc<Document>>,
) -> bool {
    let mut open = vec![(InstanceFile::Own, group.to_owned(), params.clone())];
    let mut count = 0;
    while let Some((user, name, params)) = open.pop() {
        count += 1;
        let definition = user.defining(document, &name, read);
        let Some((file, is_within)) = definition.filter(|_| count <= MOST_INSTANCES) else {
            return false;
        };
        let graph: &Graph = match is_within {
            true => &file.document(document).groups[&name].graph,
            false => &file.document(document).graph,
        };
        let Ok(knobs) = knobs::of_instance(graph, "", &params) else {
            return false;
        };
        if knobs.scale != 1.0 {
            return false;
        }
        let mut set: BTreeMap<NodeId, BTreeMap<String, Value>> = BTreeMap::new();
        for (slot, value) in knobs.settings {
            set.entry(slot.node).or_default().insert(slot.name, value);
        }
        for (id, values) in set {
            let Some(node) = graph.node(id.as_str()).filter(|node| node.kind == GROUP_KIND) else {
                continue;
            };
            let Some(inner) = node.group.clone() else {
                return false;
            };
            let mut params = node.params.clone();
            params.extend(values);
            open.push((file.clone(), inner, params));
        }
    }
    true
}
