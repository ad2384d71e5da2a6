//! Cache of graph files that are used as groups; a file is read again when it changes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use sabi_engine::OpenGraph;
use sabi_files::{PathBase, TrustedPaths, Unread};
use sabi_graph::Document;

/// Length and modification time of a file; `None` if it does not exist.
type FileStamp = Option<(u64, SystemTime)>;

#[derive(Default)]
pub(crate) struct GroupFiles {
    known: BTreeMap<PathBuf, (FileStamp, Option<Arc<Document>>)>,
}

impl GroupFiles {
    /// Removes these files from the cache, even if their length and time have not changed.
    pub(crate) fn look_again(&mut self, files: &BTreeSet<PathBuf>) {
        self.known.retain(|file, _| !files.contains(file));
    }

    /// Returns a function that reads the files that a graph refers to.
    pub(crate) fn reader<'a>(&'a mut self, graph: &'a OpenGraph) -> impl FnMut(&str) -> Option<Document> + 'a {
        let base = graph.base();
        move |written| self.read(&base, &graph.trusted, written).map(Arc::unwrap_or_clone)
    }

    /// Returns a reader of the files that a graph names, which copies none of them.
    pub(crate) fn shared_reader<'a>(
        &'a mut self,
        graph: &'a OpenGraph,
    ) -> impl FnMut(&str) -> Option<Arc<Document>> + 'a {
        let base = graph.base();
        move |written| self.read(&base, &graph.trusted, written)
    }

    /// Reads a graph file to which a file of the base refers. Returns `None` if it cannot be read or may not be opened,
    /// which the evaluation reports.
    pub(crate) fn read(&mut self, base: &PathBase, trusted: &TrustedPaths, written: &str) -> Option<Arc<Document>> {
        if matches!(trusted.check(base, written), Err(Unread::Refused(_))) {
            return None;
        }
        let path = &base.resolve(written);
        // Taken before the file is read, so that a file that is saved in the meantime counts as changed the next time.
        let stamp = stamp(path);
        if let Some((known, document)) = self.known.get(path)
            && *known == stamp
        {
            return document.clone();
        }
        let document = OpenGraph::open(path).ok().map(|open| Arc::new(open.document));
        self.known.insert(path.to_owned(), (stamp, document.clone()));
        document
    }
}

fn stamp(path: &Path) -> FileStamp {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}
