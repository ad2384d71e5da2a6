//! Nodes that a test writes itself.

use std::fs;
use std::path::PathBuf;

use sabi_engine::Kinds;
use tempfile::TempDir;

/// A folder of node files, as an artist has one beside a graph.
pub struct NodeFolder {
    folder: TempDir,
}

impl NodeFolder {
    /// A folder with these nodes: id and text.
    pub fn new(nodes: &[(&str, &str)]) -> NodeFolder {
        let folder = NodeFolder {
            folder: tempfile::tempdir().expect("a folder for nodes"),
        };
        for (id, text) in nodes {
            folder.write(id, text);
        }
        folder
    }

    /// Writes a node, new or changed; in one step, as careful editors save, so that nobody reads half of it.
    pub fn write(&self, id: &str, text: &str) {
        let path = self.file(id);
        fs::create_dir_all(path.parent().expect("a category")).expect("the folder of the category");
        let draft = self.folder.path().join("draft");
        fs::write(&draft, text).expect("the node's text");
        fs::rename(draft, path).expect("the node's file");
    }

    /// Removes a node.
    pub fn remove(&self, id: &str) {
        fs::remove_file(self.file(id)).expect("the node's file");
    }

    /// Path of the folder with the nodes.
    pub fn path(&self) -> PathBuf {
        self.folder.path().join("nodes")
    }

    fn file(&self, id: &str) -> PathBuf {
        self.path().join(format!("{id}.wgsl"))
    }

    /// The built-in kinds and these.
    ///
    /// # Panics
    /// If one of them is faulty.
    pub fn kinds(&self) -> Kinds {
        let mut kinds = Kinds::builtin();
        kinds.add_folder(&self.path());
        let faults: Vec<String> = kinds.faults.iter().map(ToString::to_string).collect();
        assert!(faults.is_empty(), "{}", faults.join("\n"));
        kinds
    }
}
