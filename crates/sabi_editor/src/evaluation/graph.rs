//! Copy of the graph that is evaluated.

use std::sync::Arc;

use sabi_editing::OpenDocument;
use sabi_engine::OpenGraph;
use sabi_graph::Document;

/// Copy of the graph that is evaluated, which is replaced if something changed that results depend on.
pub(super) struct EvaluatedGraph {
    pub(super) graph: Arc<OpenGraph>,
    /// Rises with the graph.
    pub(super) number: u64,
    /// Document without node positions and frames, which no result depends on.
    without_positions: Document,
    /// Revisions of the document and of its files at the last update.
    revisions: Option<(u64, u64)>,
}

impl EvaluatedGraph {
    pub(super) fn empty() -> EvaluatedGraph {
        EvaluatedGraph {
            graph: Arc::new(sabi_engine::Session::new(None).graph().clone()),
            number: 0,
            without_positions: Document::default(),
            revisions: None,
        }
    }

    /// Takes over the graph of a document if something changed that results depend on.
    pub(super) fn update(&mut self, document: &OpenDocument) {
        let now = (document.session.revision(), document.files_revision());
        if self.revisions == Some(now) {
            return;
        }
        let graph = document.session.graph();
        let without_positions = graph.document.without_positions();
        let has_other_files = self.revisions.is_none_or(|(_, files)| files != now.1);
        if has_other_files || graph.path != self.graph.path || without_positions != self.without_positions {
            self.graph = Arc::new(graph.clone());
            self.number += 1;
            self.without_positions = without_positions;
        }
        self.revisions = Some(now);
    }
}
