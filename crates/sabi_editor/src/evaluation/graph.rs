//! Changes of the graph that the evaluation does not have yet.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_editing::OpenDocument;
use sabi_engine::live::GraphUpdate;
use sabi_graph::Edit;

/// Largest number of edits that wait to be sent, as moves of nodes do; beyond it the whole graph is sent.
const MOST_UNSENT: usize = 1000;

/// Follows a document, and collects the changes of its graph that the evaluation does not have yet.
#[derive(Default)]
pub(super) struct GraphTracker {
    /// Rises with every change that results depend on.
    pub(super) number: u64,
    /// Change of the graph that was not sent yet.
    unsent: GraphUpdate,
    followed: Option<DocumentState>,
}

/// State of a document.
#[derive(PartialEq)]
struct DocumentState {
    revision: u64,
    files: u64,
    path: PathBuf,
}

impl GraphTracker {
    /// Collects the changes since the last call: the edits if they are known, or else the whole graph.
    pub(super) fn follow(&mut self, document: &OpenDocument) {
        let session = &document.session;
        let (revision, files) = (session.revision(), document.files_revision());
        let path = session.graph().path.as_path();
        let is_same_file = |known: &DocumentState| known.files == files && known.path == path;
        let known = self.followed.as_ref().filter(|known| is_same_file(known));
        let edits = known.and_then(|known| session.edits_since(known.revision));
        match edits.filter(|edits| self.unsent.edit_count() + edits.len() <= MOST_UNSENT) {
            Some([]) => return,
            Some(edits) => {
                self.number += u64::from(edits.iter().any(Edit::affects_results));
                self.add(edits.to_vec().into());
            }
            None => {
                self.number += 1;
                self.add(Arc::new(session.graph().clone()).into());
            }
        }
        self.followed = Some(DocumentState {
            revision,
            files,
            path: Path::to_owned(path),
        });
    }

    fn add(&mut self, update: GraphUpdate) {
        self.unsent = std::mem::take(&mut self.unsent).followed_by(update);
    }

    /// Returns the change that was not sent yet, which counts as sent from now on.
    pub(super) fn take_unsent(&mut self) -> GraphUpdate {
        std::mem::take(&mut self.unsent)
    }
}
