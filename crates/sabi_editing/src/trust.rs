//! Trust in files outside of the document's folder, and in node files beside it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sabi_engine::Kinds;
use sabi_files::TrustedPaths;

use crate::open_document::OpenDocument;

impl OpenDocument {
    /// Lets the document open a file that the user chose.
    pub fn trust_chosen(&mut self, file: &Path) {
        let graph = self.session.graph();
        // A graph without a file has no folder yet: it may be saved far from the folder in which the program was started.
        let is_below = self.session.file().is_some() && graph.base().is_above(file);
        if is_below || graph.trusted.contains(file) {
            return;
        }
        self.session.trust(&TrustedPaths::default().with_path(file));
        self.trust.chosen.push(file.to_owned());
    }

    /// Takes the files that the user has chosen and that the document was not allowed to open before.
    pub fn take_chosen(&mut self) -> Vec<PathBuf> {
        std::mem::take(&mut self.trust.chosen)
    }

    /// Lets the document open files below these paths.
    pub fn trust(&mut self, trusted: &TrustedPaths) {
        self.session.trust(trusted);
        self.files_changed(&BTreeSet::new());
    }

    /// Folders that node kinds are read from: the user's, and the one beside the document's file if it is trusted.
    pub fn node_folders(&self) -> Vec<PathBuf> {
        self.trust.node_folders(self.session.file())
    }

    /// Returns the folder of node files beside the document that is not read because it is not trusted.
    pub fn untrusted_nodes(&self) -> Option<PathBuf> {
        let beside = Kinds::folders(Some(self.session.file()?)).pop()?;
        let is_left_out = beside.is_dir() && !self.trust.allows_nodes(&beside);
        is_left_out.then_some(beside)
    }

    /// Trusts node files below these paths, starting with the next time that they are read.
    pub fn trust_nodes(&mut self, trusted: TrustedPaths) {
        self.trust.nodes = Some(trusted);
    }
}
