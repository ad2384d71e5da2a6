//! Files that an archive of a graph needs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_plan::FileFaultKind;

use super::named_files::{FileReference, NamedDocument, NamedFiles, UnopenedGroup};
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::source::session_pictures::SessionPictures;

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
            if let Some(refusal) = naming.refusal {
                let refused = EngineError::refused(&refusal);
                return Err(refused.map_messages(|why| format!("{}: {why}", naming.words)));
            }
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

    fn check_pictures(&mut self, pictures: BTreeMap<PathBuf, FileReference>) -> Result<(), EngineError> {
        let reader = SessionPictures::default();
        let mut bad = Vec::new();
        let mut remedies = BTreeSet::new();
        for (path, naming) in pictures {
            let FileReference {
                written,
                words,
                refusal,
            } = naming;
            if let Some(refusal) = refusal {
                let refused = EngineError::refused(&refusal);
                remedies.extend(refused.remedies);
                bad.push(format!("{words}: {refusal}"));
                continue;
            }
            match reader.content(&path, &written) {
                Ok(_) => drop(self.pictures.insert(path)),
                Err((_, FileFaultKind::Missing)) => self.missing.push(format!(
                    "{words} names the picture {}, which is missing",
                    path.display()
                )),
                // A graph from another person must not make the user send other files of this computer.
                Err((why, _)) => bad.push(format!("{words}: {why}")),
            }
        }
        match bad.is_empty() {
            true => Ok(()),
            false => Err(EngineError::several(ErrorKind::BadInput, bad).with_remedies(remedies)),
        }
    }
}
