//! Graph files that are used as groups, read once for each time they are saved.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sabi_engine::OpenGraph;
use sabi_graph::Document;

/// Length and time of a file; none while it is not there.
type Stamp = Option<(u64, SystemTime)>;

#[derive(Default)]
pub(crate) struct GroupFiles {
    known: BTreeMap<PathBuf, (Stamp, Option<Document>)>,
}

impl GroupFiles {
    /// Reads these files again when they are used next, however little they seem to have changed.
    pub(crate) fn look_again(&mut self, files: &BTreeSet<PathBuf>) {
        self.known.retain(|file, _| !files.contains(file));
    }

    /// A graph file; none where there is none that can be read, and the evaluation says what is wrong with it.
    pub(crate) fn read(&mut self, path: &Path) -> Option<Document> {
        // Taken first, so that a file that is saved meanwhile looks changed the next time.
        let stamp = stamp(path);
        if let Some((known, document)) = self.known.get(path)
            && *known == stamp
        {
            return document.clone();
        }
        let document = OpenGraph::open(path).ok().map(|open| open.document);
        self.known.insert(path.to_owned(), (stamp, document.clone()));
        document
    }
}

fn stamp(path: &Path) -> Stamp {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}
