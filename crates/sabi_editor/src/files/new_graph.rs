//! The graph that a new window begins with: the model's own material, given to an output, so that the model is seen as it is and
//! the first layer has a place.

use std::path::Path;

use sabi_engine::{EngineError, Session};
use sabi_graph::Document;

const TEXT: &str = r#"{
  "format": "sabi",
  "version": 1,
  "nodes": {
    "model": { "kind": "source/model", "pos": [0, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "model" }, "pos": [300, 0] }
  }
}"#;

/// A session of a new graph without a file, with nothing unsaved.
///
/// # Errors
/// The graph cannot be read, which is a defect.
pub(crate) fn session(recovery: Option<&Path>) -> Result<Session, EngineError> {
    let document = Document::from_json(TEXT).map_err(|error| {
        let why = format!("the new graph cannot be read: {error}");
        EngineError::new(sabi_engine::ErrorKind::Defect, why)
    })?;
    Ok(Session::beginning_with(document, recovery))
}

/// Returns whether a graph has no other nodes than it began with, so that the canvas shows a hint.
pub(crate) fn is_untouched(graph: &sabi_graph::Graph) -> bool {
    let is_of_start = |kind: &str| ["source/model", "output/material"].contains(&kind);
    graph.len() <= 2 && graph.nodes().all(|(_, node)| is_of_start(&node.kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_graph_has_an_output_and_nothing_unsaved() {
        let mut session = session(None).expect("a graph");
        assert!(!session.is_dirty());
        let graph = &session.document().graph;
        assert!(is_untouched(graph));
        assert!(
            graph
                .nodes()
                .any(|(id, node)| node.kind == "output/material" && !graph.inputs(id.as_str()).is_empty())
        );
    }
}
