//! Snapshots of files by metadata: whether they exist, their length and their time.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::{Changes, Watched};

/// Maximum number of entries of one folder that are checked.
const MOST_ENTRIES: usize = 4096;

/// Snapshot of all watched files.
#[derive(Default)]
pub(super) struct Snapshot {
    files: BTreeMap<PathBuf, FileSnapshot>,
}

/// Snapshot of a file.
#[derive(Default)]
struct FileSnapshot {
    /// Length and time; `None` while the file does not exist.
    stamp: Option<(u64, SystemTime)>,
    /// Canonical path; `None` while its folder does not exist.
    place: Option<PathBuf>,
}

/// Files that changed between two snapshots.
pub(super) struct Changed(BTreeSet<PathBuf>);

impl Snapshot {
    pub(super) fn at(watched: &Watched) -> Snapshot {
        let nodes = watched.nodes.iter().flat_map(|folder| node_files(folder));
        let others = watched.graph.iter().chain(&watched.model).chain(&watched.files);
        let mut folders = BTreeMap::new();
        let files = nodes.chain(others.cloned());
        Snapshot {
            files: files
                .map(|file| {
                    let snapshot = file_snapshot(&file, &mut folders);
                    (file, snapshot)
                })
                .collect(),
        }
    }

    /// Lists the changes since an earlier snapshot: files whose metadata differ, and those named by events.
    pub(super) fn since(&self, before: &Snapshot, reported: &BTreeSet<PathBuf>) -> Changed {
        let is_changed = |file: &&PathBuf| {
            let [now, before] = [self, before].map(|snapshot| snapshot.files.get(*file));
            let stamp = |file: Option<&FileSnapshot>| file.and_then(|file| file.stamp);
            let is_reported = |file: &FileSnapshot| file.place.as_ref().is_some_and(|place| reported.contains(place));
            stamp(now) != stamp(before) || now.is_some_and(is_reported)
        };
        let files: BTreeSet<&PathBuf> = self.files.keys().chain(before.files.keys()).collect();
        Changed(files.into_iter().filter(is_changed).cloned().collect())
    }
}

impl Changed {
    /// Converts the changed files to the changes of a session.
    pub(super) fn of(self, watched: &Watched) -> Changes {
        let is_changed = |file: &&PathBuf| self.0.contains(*file);
        let is_node = |file: &PathBuf| watched.nodes.iter().any(|folder| is_node_of(folder, file));
        Changes {
            graph: watched.graph.iter().any(|file| is_changed(&file)),
            nodes: self.0.iter().any(is_node),
            model: watched.model.iter().any(|file| is_changed(&file)),
            files: watched.files.iter().filter(is_changed).cloned().collect(),
        }
    }
}

fn file_snapshot(file: &Path, folders: &mut BTreeMap<PathBuf, Option<PathBuf>>) -> FileSnapshot {
    let stamp = fs::metadata(file).and_then(|metadata| Ok((metadata.len(), metadata.modified()?)));
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let found = folders.entry(folder.to_owned());
    let folder = found.or_insert_with_key(|folder| fs::canonicalize(folder).ok());
    FileSnapshot {
        stamp: stamp.ok(),
        place: folder.as_ref().and_then(|folder| Some(folder.join(file.file_name()?))),
    }
}

/// Lists the files of nodes and their libraries.
fn node_files(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let files = subfolders(folder).flat_map(|category| entries(&category));
    files.filter(|file| is_wgsl(file))
}

/// Lists the direct subfolders of a folder.
pub(super) fn subfolders(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    entries(folder).filter(|entry| entry.is_dir())
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let entries = fs::read_dir(folder).into_iter().flatten().take(MOST_ENTRIES);
    entries.filter_map(|entry| Some(entry.ok()?.path()))
}

fn is_wgsl(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending == "wgsl")
}

/// Returns true if a file may be a node or a library in a folder of node files.
fn is_node_of(folder: &Path, file: &Path) -> bool {
    is_wgsl(file) && file.parent().and_then(Path::parent) == Some(folder)
}
