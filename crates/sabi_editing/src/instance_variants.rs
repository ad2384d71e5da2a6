//! Variants of group instances, chosen as a whole.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, GROUP_KIND, NodeId, Value};

use crate::open_document::OpenDocument;

/// Gives an instance a variant of its group, or the group's own values. Values of its own stay only where no variant has any, so
/// that the instance looks as the variant does.
pub fn choose(document: &mut OpenDocument, id: &NodeId, name: Option<&str>) -> bool {
    match choosing(document, id, name) {
        Some(edits) => document.edit("Choose variant", edits),
        None => document.refuse("only an instance of a group has variants"),
    }
}

/// Edits that give an instance a variant; none for other nodes.
pub(crate) fn choosing(document: &OpenDocument, id: &NodeId, name: Option<&str>) -> Option<Vec<Edit>> {
    let node = document.node(id).filter(|node| node.kind == GROUP_KIND)?;
    let group = node
        .group
        .as_ref()
        .and_then(|group| document.contents().groups.get(group));
    // The variants of a group in a file of its own are checked when the graph is evaluated.
    let variants = group.into_iter().flat_map(|group| group.graph.variants().values());
    let knobs: BTreeSet<&String> = variants.flat_map(BTreeMap::keys).collect();
    let own = node.params.keys().filter(|param| knobs.contains(param));
    let set = |param: &str, value: Option<Value>| Edit::SetParam {
        body: document.body(),
        node: id.clone(),
        param: param.to_owned(),
        value,
    };
    let reset = own.map(|param| set(param, None));
    let variant = set("variant", name.map(Value::from));
    Some(reset.chain([variant]).collect())
}
