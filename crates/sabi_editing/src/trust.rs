//! Trust in files outside of the document's folder, and in node files beside it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sabi_engine::Kinds;
use sabi_files::TrustedPaths;

use crate::open_document::OpenDocument;

/// Lets the document open a file that the user chose.
pub(crate) fn trust_chosen(document: &mut OpenDocument, file: &Path) {
    let graph = document.session.graph();
    // A graph without a file has no folder yet: it may be saved far from the folder in which the program was started.
    let is_below = document.session.file().is_some() && graph.base().is_above(file);
    if is_below || graph.trusted.contains(file) {
        return;
    }
    document.session.trust(&TrustedPaths::default().with_path(file));
    document.trust.chosen.push(file.to_owned());
}

/// Takes the files that the user has chosen and that the document was not allowed to open before.
pub fn take_chosen(document: &mut OpenDocument) -> Vec<PathBuf> {
    std::mem::take(&mut document.trust.chosen)
}

/// Lets the document open files below these paths.
pub fn trust_files(document: &mut OpenDocument, trusted: &TrustedPaths) {
    document.session.trust(trusted);
    document.files_changed(&BTreeSet::new());
}

/// Folders that node kinds are read from: the user's, and the one beside the document's file if it is trusted.
pub fn node_folders(document: &OpenDocument) -> Vec<PathBuf> {
    document.trust.node_folders(document.session.file())
}

/// Returns the folder of node files beside the document that is not read because it is not trusted.
pub fn untrusted_nodes(document: &OpenDocument) -> Option<PathBuf> {
    let beside = Kinds::folders(Some(document.session.file()?)).pop()?;
    let is_left_out = beside.is_dir() && !document.trust.allows_nodes(&beside);
    is_left_out.then_some(beside)
}

/// Trusts node files below these paths, starting with the next time that they are read.
pub fn trust_nodes(document: &mut OpenDocument, trusted: TrustedPaths) {
    document.trust.nodes = Some(trusted);
}
