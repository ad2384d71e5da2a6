//! Edits that would prevent any evaluation. They are refused.
//!
//! A faulty node is reported at that node, and the rest of the graph is still evaluated. A faulty group instance, however,
//! prevents the evaluation of the whole graph.

use std::sync::Arc;

use sabi_graph::{
    Document, Edit, GROUP_KIND, Node, Overrides, Preview, ReadShared, SlotRef, Value, flatten, takes_values,
};

/// Returns the reason why the graph could not be evaluated after these edits. Returns `None` if it still could, or if it
/// cannot be evaluated now either. `read` reads group files by name.
pub(crate) fn reason_lost_by(document: &Document, edits: &[Edit], read: ReadShared<'_>) -> Option<String> {
    if edits.iter().all(|edit| keeps_instances(document, edit, read)) {
        return None;
    }
    let mut after = document.clone();
    // An edit that is refused changes nothing.
    after.apply(Edit::Batch(edits.to_vec())).ok()?;
    let reason = evaluation_fault(&after, read)?;
    let is_evaluable_now = evaluation_fault(document, read).is_none();
    is_evaluable_now.then_some(reason)
}

/// Returns whether an edit cannot break a group instance, in which case the costly check is skipped.
fn keeps_instances(document: &Document, edit: &Edit, read: ReadShared<'_>) -> bool {
    match edit {
        Edit::Batch(edits) => edits.iter().all(|edit| keeps_instances(document, edit, read)),
        Edit::SetParam {
            body,
            node,
            param,
            value,
        } => {
            let node = document.body(body).ok().and_then(|graph| graph.node(node.as_str()));
            node.is_none_or(|node| node.kind != GROUP_KIND || takes_value(document, node, param, value.as_ref(), read))
        }
        Edit::SetPreview { preview } => {
            let variant = |preview: &Option<Preview>| preview.as_ref().and_then(|preview| preview.variant.clone());
            variant(preview) == variant(&document.preview)
        }
        // A variant that only sets parameters of ordinary nodes cannot break an instance. Such values are checked at their nodes.
        Edit::SetVariant {
            body,
            name,
            values: Some(_),
        } => document.body(body).is_ok_and(|graph| {
            let is_instance = |slot: &SlotRef| {
                graph
                    .node(slot.node.as_str())
                    .is_some_and(|node| node.kind == GROUP_KIND)
            };
            let controlled = graph.exposed().values().flat_map(|knob| &knob.to);
            graph.variants().contains_key(name) && !controlled.into_iter().any(is_instance)
        }),
        Edit::Move { .. }
        | Edit::SetLabel { .. }
        | Edit::SetMuted { .. }
        | Edit::SetDisplay { .. }
        | Edit::SetNote { .. }
        | Edit::Disconnect { .. }
        | Edit::AddFrame { .. }
        | Edit::RemoveFrame { .. }
        | Edit::RenameDocument { .. }
        | Edit::SetFit { .. }
        | Edit::SetSeed { .. } => true,
        _ => false,
    }
}

/// Returns whether the group of an instance surely takes a value, or its absence.
fn takes_value(document: &Document, instance: &Node, param: &str, value: Option<&Value>, read: ReadShared<'_>) -> bool {
    let mut params = instance.params.clone();
    match value {
        Some(value) => params.insert(param.to_owned(), value.clone()),
        None => params.remove(param),
    };
    let group = instance.group.as_deref();
    group.is_some_and(|group| takes_values(document, group, &params, read))
}

/// Returns the reason why the graph cannot be evaluated with its own values, or with the variant that is shown.
fn evaluation_fault(document: &Document, read: ReadShared<'_>) -> Option<String> {
    let mut read = |name: &str| {
        let file = read(name).map(Arc::unwrap_or_clone);
        file.ok_or_else(|| "it cannot be read; open it to see why".to_owned())
    };
    let (own, shown) = (Overrides::default(), Overrides::of_preview(document));
    let shown = Some(shown).filter(|shown| *shown != own);
    let mut faults = std::iter::once(own).chain(shown);
    faults.find_map(|overrides| {
        flatten(document, &overrides, &mut read)
            .err()
            .map(|error| error.to_string())
    })
}
