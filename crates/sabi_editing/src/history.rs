//! Undo and redo.

use std::collections::BTreeSet;

use sabi_graph::{EditError, NodeId};

use crate::open_document::OpenDocument;

/// The nodes that are shown, before a step of the history.
struct ShownNodes {
    /// Number of instances that are entered.
    entered_instances: usize,
    ids: BTreeSet<NodeId>,
}

impl ShownNodes {
    fn of(document: &OpenDocument) -> ShownNodes {
        ShownNodes {
            entered_instances: document.place().instance_path().len(),
            ids: document.graph().ids().cloned().collect(),
        }
    }
}

/// Undoes the last step, and selects the nodes that come back.
pub fn undo(document: &mut OpenDocument) {
    let before = ShownNodes::of(document);
    let undone = document.session.undo();
    moved(document, undone, "Undone", &before);
}

/// Redoes the last step that was undone, and selects the nodes that come back.
pub fn redo(document: &mut OpenDocument) {
    let before = ShownNodes::of(document);
    let redone = document.session.redo();
    moved(document, redone, "Redone", &before);
}

/// Cancels the step that was started with `session.begin`: the document is restored to its state before the step.
pub fn cancel_step(document: &mut OpenDocument) {
    if let Err(error) = document.session.cancel() {
        document.notify(error.to_string());
    }
    document.refresh();
}

fn moved(document: &mut OpenDocument, moved: Result<Option<String>, EditError>, verb: &str, before: &ShownNodes) {
    match moved {
        Ok(Some(name)) => document.notify(format!("{verb}: {name}")),
        Ok(None) => {}
        Err(error) => document.notify(error.to_string()),
    }
    document.refresh();
    let ids = document.graph().ids();
    let returned: Vec<NodeId> = ids.filter(|id| !before.ids.contains(*id)).cloned().collect();
    if before.entered_instances == document.place().instance_path().len() && !returned.is_empty() {
        document.select(returned);
    }
}
