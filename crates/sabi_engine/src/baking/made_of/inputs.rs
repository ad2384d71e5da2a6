//! Files that a bake reads, identified by their content.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sabi_files::{TrustedPaths, absolute, stored_path, without_detours};
use sabi_nodes::files_of_folder;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::opening::kinds::Kinds;
use crate::program::digest;

/// Content of a file that a bake read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct InputRecord {
    /// Path of the file.
    pub path: String,
    /// Length of the file; `None` if no file could be read.
    pub bytes: Option<u64>,
    /// BLAKE3 of the file's bytes, hexadecimal; `None` if no file could be read.
    pub blake3: Option<String>,
}

impl InputRecord {
    fn of(path: PathBuf) -> InputRecord {
        let (bytes, blake3) = digest(&path).unzip();
        InputRecord {
            path: stored_path(&path),
            bytes,
            blake3,
        }
    }
}

/// Records files with absolute paths, sorted and without repeats.
pub(crate) fn records(files: impl IntoIterator<Item = PathBuf>) -> Vec<InputRecord> {
    let mut paths: Vec<PathBuf> = files
        .into_iter()
        .map(|path| without_detours(&absolute(&path)))
        .collect();
    paths.sort();
    paths.dedup();
    let mut records: Vec<InputRecord> = paths.into_par_iter().map(InputRecord::of).collect();
    records.sort();
    records
}

/// Lists the node files beside a graph and in the user's folder. All of them count as read, since each may replace a kind.
pub(crate) fn node_files(graph: &Path, trusted: &TrustedPaths) -> Vec<PathBuf> {
    let folders = Kinds::folders(Some(graph)).into_iter();
    folders
        .flat_map(|folder| files_of_folder(&folder, &Kinds::trusted_for(&folder, trusted)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_recorded_once_by_their_content_and_missing_ones_too() {
        let folder = tempfile::tempdir().unwrap();
        let [one, two] = ["b.png", "a.png"].map(|name| folder.path().join(name));
        std::fs::write(&one, b"bytes").unwrap();
        let again = folder.path().join("below").join("..").join("b.png");
        let found = records([one.clone(), two.clone(), again]);
        let expected = [
            InputRecord {
                path: stored_path(&two),
                bytes: None,
                blake3: None,
            },
            InputRecord {
                path: stored_path(&one),
                bytes: Some(5),
                blake3: Some(blake3::hash(b"bytes").to_hex().to_string()),
            },
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn all_node_files_beside_a_graph_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let nodes = folder.path().join("nodes/lib");
        std::fs::create_dir_all(&nodes).unwrap();
        std::fs::create_dir_all(folder.path().join("nodes/own")).unwrap();
        // Outside of the category folders, no node is read.
        for name in [
            "nodes/own/my.wgsl",
            "nodes/lib/noise.wgsl",
            "nodes/own/notes.txt",
            "nodes/beside.wgsl",
            "other.wgsl",
        ] {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        let own = node_files(&folder.path().join("graph.sabi"), &TrustedPaths::default()).into_iter();
        let mut own: Vec<PathBuf> = own.filter(|path| path.starts_with(folder.path())).collect();
        own.sort();
        let expected = ["nodes/lib/noise.wgsl", "nodes/own/my.wgsl"].map(|name| folder.path().join(name));
        assert_eq!(own, expected);
    }
}
