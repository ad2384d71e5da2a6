//! Trust that belongs to the open document.

use std::path::{Path, PathBuf};

use sabi_engine::Kinds;
use sabi_files::TrustedPaths;

/// Trust that belongs to the open document, not to its session.
#[derive(Default)]
pub(crate) struct Trust {
    /// Files that the user has chosen since this list was last taken.
    pub(crate) chosen: Vec<PathBuf>,
    /// Paths below which node files beside the document are trusted; `None` means all places.
    pub(crate) nodes: Option<TrustedPaths>,
}

impl Trust {
    /// Returns the trusted folders of node files for a graph file.
    pub(crate) fn node_folders(&self, graph: Option<&Path>) -> Vec<PathBuf> {
        let mut folders = Kinds::folders(graph);
        if graph.is_some() && folders.last().is_some_and(|beside| !self.allows_nodes(beside)) {
            folders.pop();
        }
        folders
    }

    pub(crate) fn allows_nodes(&self, folder: &Path) -> bool {
        self.nodes.as_ref().is_none_or(|trusted| trusted.contains(folder))
    }
}
