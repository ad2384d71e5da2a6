//! Copies of unsaved work, in case the program ends.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::{Duration, Instant};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::catalog::node_file::NodeDraft;
use sabi_engine::session::Keeping;

/// Time between two autosaves.
const AUTOSAVE_EVERY: Duration = Duration::from_secs(3);

/// Copies of unsaved work, in case the program ends.
pub(crate) struct Autosave {
    at: Instant,
    /// Revisions of the graph and of node files that were saved last.
    saved: Option<(u64, u64)>,
    /// Revision of the graph that was saved last, and the hash of the kinds of its nodes.
    kinds: Option<(u64, u64)>,
    pub(crate) every: Duration,
}

impl Default for Autosave {
    fn default() -> Autosave {
        Autosave {
            at: Instant::now(),
            saved: None,
            kinds: None,
            every: AUTOSAVE_EVERY,
        }
    }
}

impl Autosave {
    /// Makes the next autosave write copies even if nothing was edited.
    pub(crate) fn invalidate(&mut self) {
        self.saved = None;
    }

    /// Saves copies of the graph and of node files in the background, if they have changed.
    ///
    /// # Errors
    /// They cannot be written; the error is a sentence.
    pub(super) fn save(
        &mut self,
        document: &mut OpenDocument,
        drafts: &[NodeDraft],
        drafts_revision: u64,
    ) -> Result<(), String> {
        self.at = Instant::now();
        self.saved = Some((document.session.revision(), drafts_revision));
        self.kinds = Some((document.session.revision(), kinds_hash(document)));
        match document.session.keep_meanwhile(drafts) {
            Ok(Keeping::Done) => Ok(()),
            Ok(keeping) => {
                // The next autosave checks whether the copies were written.
                self.saved = None;
                if keeping == Keeping::Postponed {
                    self.kinds = None;
                }
                Ok(())
            }
            Err(error) => {
                self.saved = None;
                Err(format!("Autosave failed: {error}"))
            }
        }
    }

    /// Returns whether the next autosave is due: after some time, and at once after nodes were added, deleted or replaced, since a
    /// driver that compiles a new kernel may hold up the window.
    pub(super) fn is_due(&self, document: &OpenDocument) -> bool {
        // Most frames change nothing, so that nothing is hashed in them.
        let has_new_kinds = self
            .kinds
            .is_none_or(|(revision, hash)| revision != document.session.revision() && hash != kinds_hash(document));
        has_new_kinds || self.at.elapsed() >= self.every
    }

    /// Requests a frame for the next autosave, if there is something to save.
    pub(super) fn schedule(&self, context: &Context, document: &OpenDocument, drafts_revision: u64) {
        if self.saved != Some((document.session.revision(), drafts_revision)) {
            context.request_repaint_after(self.every);
        }
    }
}

/// Hash of the nodes of the graph and of its groups with their kinds.
fn kinds_hash(document: &OpenDocument) -> u64 {
    let contents = document.contents();
    let groups = contents.groups.values().map(|group| &group.graph);
    let mut hasher = DefaultHasher::new();
    for graph in groups.chain([&contents.graph]) {
        graph.nodes().for_each(|(id, node)| (id, &node.kind).hash(&mut hasher));
    }
    hasher.finish()
}

/// Saves recovery copies when no window is left to report an error.
pub(super) fn autosave_at_end(document: &mut OpenDocument, drafts: &[NodeDraft]) {
    // A drag may have left an undo step open.
    document.session.end();
    if let Err(error) = document.session.keep(drafts) {
        tracing::error!("what is not saved cannot be kept: {error}");
    }
}
