//! Edits after which nothing could be evaluated, which are refused.
//!
//! A fault of a node is reported at that node, and the rest of the graph is still evaluated. A fault of a group instance
//! prevents the evaluation of the whole graph.

use sabi_graph::{Document, Edit, GROUP_KIND, Overrides, flatten};

/// Returns why nothing could be evaluated after these edits, unless nothing can be evaluated now either. `read` reads group
/// files by their names.
pub(crate) fn why_lost_by(
    document: &Document,
    edits: &[Edit],
    read: &mut dyn FnMut(&str) -> Option<Document>,
) -> Option<String> {
    if edits.iter().all(|edit| keeps_instances(document, edit)) {
        return None;
    }
    let mut after = document.clone();
    // Edits that are refused change nothing.
    after.apply(Edit::Batch(edits.to_vec())).ok()?;
    let why = why_not_evaluable(&after, read)?;
    let is_evaluable_now = why_not_evaluable(document, read).is_none();
    is_evaluable_now.then_some(why)
}

/// Whether an edit cannot break a group instance, so that the costly check is not needed.
fn keeps_instances(document: &Document, edit: &Edit) -> bool {
    match edit {
        Edit::Batch(edits) => edits.iter().all(|edit| keeps_instances(document, edit)),
        Edit::SetParam { body, node, .. } => {
            let node = document.body(body).ok().and_then(|graph| graph.node(node.as_str()));
            node.is_none_or(|node| node.kind != GROUP_KIND)
        }
        Edit::Move { .. }
        | Edit::SetLabel { .. }
        | Edit::SetMuted { .. }
        | Edit::Disconnect { .. }
        | Edit::AddFrame { .. }
        | Edit::RemoveFrame { .. }
        | Edit::RenameDocument { .. }
        | Edit::SetPreview { .. }
        | Edit::SetFit { .. }
        | Edit::SetSeed { .. } => true,
        _ => false,
    }
}

fn why_not_evaluable(document: &Document, read: &mut dyn FnMut(&str) -> Option<Document>) -> Option<String> {
    let mut read = |name: &str| read(name).ok_or_else(|| "it cannot be read; open it to see why".to_owned());
    let flat = flatten(document, &Overrides::default(), &mut read);
    flat.err().map(|error| error.to_string())
}
