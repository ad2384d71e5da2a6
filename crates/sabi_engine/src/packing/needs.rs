//! Files that an archive of a graph needs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::named_files::{NamedDocument, NamedFiles, Naming, UnopenedGroup};
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::source::pictures::Pictures;

/// Files that a graph names.
pub(super) struct Needs {
    /// The graph, and its group files.
    pub(super) documents: Vec<NamedDocument>,
    /// Pictures of its nodes.
    pub(super) pictures: BTreeSet<PathBuf>,
    /// Sentences about files that are missing.
    pub(super) missing: Vec<String>,
}

impl Needs {
    /// Collects what a graph names, in all its variants.
    ///
    /// # Errors
    /// A group file is damaged, or a picture is none.
    pub(super) fn of(open: OpenGraph, kinds: &Kinds) -> Result<Needs, EngineError> {
        let named = NamedFiles::of(open, kinds);
        let mut needs = Needs {
            documents: named.documents,
            pictures: BTreeSet::new(),
            missing: Vec::new(),
        };
        for UnopenedGroup { path, naming, error } in named.unopened {
            if error.kind != ErrorKind::MissingInput {
                return Err(error);
            }
            let (words, path) = (naming.words, path.display());
            needs
                .missing
                .push(format!("{words} names the group file {path}, which is missing"));
        }
        needs.check_pictures(named.pictures)?;
        Ok(needs)
    }

    fn check_pictures(&mut self, pictures: BTreeMap<PathBuf, Naming>) -> Result<(), EngineError> {
        let reader = Pictures::default();
        let mut bad = Vec::new();
        for (path, Naming { written, words }) in pictures {
            match reader.content(&path, &written) {
                Ok(_) => drop(self.pictures.insert(path)),
                Err((_, true)) => self.missing.push(format!(
                    "{words} names the picture {}, which is missing",
                    path.display()
                )),
                // A graph from elsewhere must not make anyone send other files of their computer.
                Err((why, false)) => bad.push(format!("{words}: {why}")),
            }
        }
        match bad.is_empty() {
            true => Ok(()),
            false => Err(EngineError::several(ErrorKind::BadInput, bad)),
        }
    }
}
