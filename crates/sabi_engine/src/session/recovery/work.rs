//! Content of a recovery file: the unsaved work of a session.

use std::path::{Path, PathBuf};

use sabi_files::{path_from_stored, stored_path};
use serde_json::{Value as Json, json};

use crate::catalog::node_file::NodeDraft;

/// Unsaved work of a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::session) struct UnsavedWork {
    /// The graph's text; `None` if it is in the graph's file.
    pub(in crate::session) graph: Option<String>,
    /// Drafts of node files.
    pub(in crate::session) drafts: Vec<NodeDraft>,
    /// Hash of the content of the graph's own file at that time.
    pub(in crate::session) file_hash: Option<String>,
}

impl UnsavedWork {
    /// Returns the bytes of a recovery file, with the path of the graph's own file.
    pub(super) fn to_bytes(&self, file: Option<&Path>) -> Vec<u8> {
        let drafts: Vec<Json> = self.drafts.iter().map(NodeDraft::to_json).collect();
        let json = json!({
            "file": file.map(stored_path),
            "file_hash": self.file_hash,
            "graph": self.graph,
            "drafts": drafts,
        });
        json.to_string().into_bytes()
    }

    /// Reads the text of a recovery file, and the path of the graph's own file.
    ///
    /// # Errors
    /// A clause about what is wrong with it.
    pub(super) fn read(text: &str) -> Result<(UnsavedWork, Option<PathBuf>), String> {
        let stored: Json = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let graph = match &stored["graph"] {
            Json::String(graph) => Some(graph.clone()),
            Json::Null if stored["drafts"].is_array() => None,
            _ => return Err("it holds no graph".to_owned()),
        };
        let drafts = stored["drafts"].as_array().map_or(&[][..], Vec::as_slice);
        let drafts: Option<Vec<NodeDraft>> = drafts.iter().map(NodeDraft::from_json).collect();
        let work = UnsavedWork {
            graph,
            drafts: drafts.ok_or("a node in it has no text")?,
            file_hash: stored["file_hash"].as_str().map(str::to_owned),
        };
        let file = match &stored["file"] {
            Json::String(text) => Some(path_from_stored(text).ok_or("its path is damaged")?),
            _ => None,
        };
        Ok((work, file))
    }
}
