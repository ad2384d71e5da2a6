//! Edits of a session's document, and the revisions that they lead to.

use std::sync::atomic::{AtomicU64, Ordering};

use sabi_graph::{Document, Edit, EditError, History, Relocation};

/// First revision of the next session of this process, so that no two sessions ever have the same revision.
static FIRST_REVISION: AtomicU64 = AtomicU64::new(0);
/// Number of revisions reserved for each session, which is never reached.
const REVISIONS: u64 = 1 << 32;
/// Maximum number of edits that are kept for readers that follow the document.
pub(super) const RECENT_EDITS: usize = 256;

/// History of the edits of one document, its revision, and its last edits. The document is passed to each edit.
#[derive(Debug)]
pub(super) struct Edits {
    history: History,
    /// Revision of the document. It rises with every change.
    revision: u64,
    /// The last edits, each of which raised the revision by one.
    recent: Vec<Edit>,
}

impl Edits {
    /// Creates an empty history of a document that was opened.
    pub(super) fn new() -> Edits {
        Edits {
            history: History::new(),
            revision: FIRST_REVISION.fetch_add(REVISIONS, Ordering::Relaxed),
            recent: Vec::new(),
        }
    }

    /// Steps that can be undone and redone.
    pub(super) fn history(&self) -> &History {
        &self.history
    }

    /// Revision of the document.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// Applies an edit, as a step with a name or as a part of the open step. An edit without effect adds no step.
    pub(super) fn apply(&mut self, document: &mut Document, name: &str, edit: Edit) -> Result<(), EditError> {
        if document.is_unchanged_by(&edit) {
            return Ok(());
        }
        let followed = (!edit.replaces_graphs()).then(|| edit.clone());
        self.history.apply(document, name, edit)?;
        self.revision += 1;
        match followed {
            Some(edit) => self.recent.push(edit),
            None => self.recent.clear(),
        }
        if self.recent.len() > RECENT_EDITS {
            self.recent.drain(..RECENT_EDITS / 2);
        }
        Ok(())
    }

    /// Applies an edit that is not a step.
    pub(super) fn apply_aside(&mut self, document: &mut Document, edit: Edit) -> Result<(), EditError> {
        if document.is_unchanged_by(&edit) {
            return Ok(());
        }
        document.apply(edit)?;
        self.changed_otherwise();
        Ok(())
    }

    /// Returns the edits since a revision, oldest first; `None` if the document has changed in other ways, or if the revision is too old.
    pub(super) fn since(&self, revision: u64) -> Option<&[Edit]> {
        let count = usize::try_from(self.revision.checked_sub(revision)?).ok()?;
        self.recent.get(self.recent.len().checked_sub(count)?..)
    }

    /// Raises the revision after a change that is not a list of edits.
    pub(super) fn changed_otherwise(&mut self) {
        self.revision += 1;
        self.recent.clear();
    }

    /// Begins a step of several edits.
    pub(super) fn begin(&mut self, name: &str) {
        self.history.begin(name);
    }

    /// Ends the step that was begun.
    pub(super) fn end(&mut self) {
        self.history.end();
    }

    /// Undoes all edits of the open step and removes them from the history.
    pub(super) fn cancel(&mut self, document: &mut Document) -> Result<(), EditError> {
        self.changed_otherwise();
        self.history.cancel(document)
    }

    /// Undoes the last step and returns its name.
    pub(super) fn undo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        let undone = self.history.undo(document)?;
        if undone.is_some() {
            self.changed_otherwise();
        }
        Ok(undone)
    }

    /// Redoes the last undone step and returns its name.
    pub(super) fn redo(&mut self, document: &mut Document) -> Result<Option<String>, EditError> {
        let redone = self.history.redo(document)?;
        if redone.is_some() {
            self.changed_otherwise();
        }
        Ok(redone)
    }

    /// Rewrites paths in all steps. `document` is the document that the steps lead to.
    pub(super) fn relocate(&mut self, document: &Document, relocation: Relocation<'_>) {
        self.history.relocate(document, relocation);
    }
}
