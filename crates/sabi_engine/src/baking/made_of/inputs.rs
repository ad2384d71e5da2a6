//! Files that a bake reads, by their content.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sabi_files::{absolute, stored_path, without_detours};
use serde::{Deserialize, Serialize};

use crate::opening::kinds::Kinds;
use crate::program::digest;

/// Content of a file that a bake read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct InputRecord {
    /// Path of the file.
    pub path: String,
    /// Length of the file; `None` where there was no file that could be read.
    pub bytes: Option<u64>,
    /// BLAKE3 of the file's bytes, hexadecimal; `None` where there was no file that could be read.
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

/// Records files with absolute paths, sorted and each once.
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

/// Lists the node files beside a graph and in the user's folder. All of them count as read: each may take the place of a kind.
pub(crate) fn node_files(graph: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = Kinds::folders(Some(graph));
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for entry in entries {
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => folders.push(entry.path()),
                Ok(_) if entry.path().extension().is_some_and(|ending| ending == "wgsl") => found.push(entry.path()),
                _ => {}
            }
        }
    }
    found
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
        for name in ["nodes/my.wgsl", "nodes/lib/noise.wgsl", "nodes/notes.txt", "other.wgsl"] {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        let own = node_files(&folder.path().join("graph.sabi")).into_iter();
        let mut own: Vec<PathBuf> = own.filter(|path| path.starts_with(folder.path())).collect();
        own.sort();
        let expected = ["nodes/lib/noise.wgsl", "nodes/my.wgsl"].map(|name| folder.path().join(name));
        assert_eq!(own, expected);
    }
}
