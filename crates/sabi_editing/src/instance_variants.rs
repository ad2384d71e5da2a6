//! Variants of group instances, chosen as a whole.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::{Edit, GROUP_KIND, NodeId, Value};

use crate::open_document::OpenDocument;

/// Sets the variant of an instance, or the group's own values. Values of the instance are removed if any variant sets the
/// same knob, so that the instance looks like the variant.
pub fn choose(document: &mut OpenDocument, id: &NodeId, name: Option<&str>) -> bool {
    match choosing(document, id, name) {
        Some(edits) => document.edit("Choose variant", edits),
        None => document.refuse("only an instance of a group has variants"),
    }
}

/// Returns the edits that set the variant of an instance; none for other nodes.
pub(crate) fn choosing(document: &OpenDocument, id: &NodeId, name: Option<&str>) -> Option<Vec<Edit>> {
    let node = document.node(id).filter(|node| node.kind == GROUP_KIND)?;
    let group = node
        .group
        .as_ref()
        .and_then(|group| document.contents().groups.get(group));
    // Variants of a group file are checked when the graph is evaluated.
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
