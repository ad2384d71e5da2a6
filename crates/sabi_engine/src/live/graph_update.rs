//! Updates of the evaluator's graph, which is being edited.

use std::sync::Arc;

use sabi_graph::Edit;

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;

/// Change of the evaluated graph since the previous request. With edits, the document need not be copied for each move of a slider.
#[derive(Clone, Debug, Default)]
pub struct GraphUpdate {
    /// Graph that replaces the previous one; `None` if edits alone describe the change.
    whole: Option<Arc<OpenGraph>>,
    /// Edits after that, oldest first.
    edits: Vec<Edit>,
}

impl From<Arc<OpenGraph>> for GraphUpdate {
    fn from(graph: Arc<OpenGraph>) -> GraphUpdate {
        GraphUpdate {
            whole: Some(graph),
            edits: Vec::new(),
        }
    }
}

impl From<Vec<Edit>> for GraphUpdate {
    fn from(edits: Vec<Edit>) -> GraphUpdate {
        GraphUpdate { whole: None, edits }
    }
}

impl GraphUpdate {
    /// Returns the number of edits.
    pub fn edit_count(&self) -> usize {
        self.edits.len()
    }

    /// Returns one update with the effect of this update followed by another one.
    #[must_use]
    pub fn followed_by(mut self, next: GraphUpdate) -> GraphUpdate {
        if next.whole.is_some() {
            return next;
        }
        self.edits.extend(next.edits);
        self
    }

    /// Updates a graph.
    ///
    /// # Errors
    /// An edit does not apply, which is a defect of its sender.
    pub(super) fn apply(self, graph: &mut Arc<OpenGraph>) -> Result<(), EngineError> {
        if let Some(whole) = self.whole {
            *graph = whole;
        }
        if self.edits.is_empty() {
            return Ok(());
        }
        let document = &mut Arc::make_mut(graph).document;
        document.apply(Edit::Batch(self.edits)).map_err(|error| {
            let why = format!("the evaluation could not follow an edit, which is a defect of Sabi: {error}");
            EngineError::new(ErrorKind::Defect, why)
        })?;
        Ok(())
    }
}
