//! Edits after which nothing could be evaluated, which are refused.
//!
//! A fault of a node is reported at that node, and the rest of the graph is still evaluated. A fault of a group instance
//! prevents the evaluation of the whole graph.

use sabi_graph::{Document, Edit, GROUP_KIND, Overrides, flatten};

/// Returns the reason why nothing could be evaluated after these edits; none if nothing can be evaluated now either. `read`
/// reads group files by their names.
pub(crate) fn reason_lost_by(
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
    let reason = evaluation_fault(&after, read)?;
    let is_evaluable_now = evaluation_fault(document, read).is_none();
    is_evaluable_now.then_some(reason)
}

/// Returns whether an edit cannot break a group instance, in which case the costly check is skipped.
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

fn evaluation_fault(document: &Document, read: &mut dyn FnMut(&str) -> Option<Document>) -> Option<String> {
    let mut read = |name: &str| read(name).ok_or_else(|| "it cannot be read; open it to see why".to_owned());
    let flat = flatten(document, &Overrides::default(), &mut read);
    flat.err().map(|error| error.to_string())
}
