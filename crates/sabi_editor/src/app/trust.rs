//! Trust in files that lie outside of the folder of the graph or model that names them.

use std::path::{Path, PathBuf};

use sabi_editing::{missing_files, trust};
use sabi_files::{PathBase, TrustedPaths};

use super::documents::Documents;
use super::shell::Shell;
use crate::evaluation::Evaluation;
use crate::settings::Settings;

/// Lets this graph and all later ones use the node files of a folder.
pub(super) fn trust_nodes(documents: &mut Documents, shell: &mut Shell, folder: &PathBuf) {
    shell.settings.trust_nodes(folder);
    documents.trust_nodes(folder);
    documents.reread_kinds(&shell.context, std::slice::from_ref(folder));
}

/// Lets this graph and all later ones open a file or the files of a folder.
pub(super) fn trust_path(documents: &mut Documents, settings: &mut Settings, path: &Path) {
    settings.trust(path);
    documents.trust(&TrustedPaths::default().with_path(path));
}

/// Remembers the files that the user chose for the graph, so that it opens them the next time.
pub(super) fn remember_chosen(documents: &mut Documents, settings: &mut Settings) {
    for file in trust::take_chosen(&mut documents.document) {
        trust_path(documents, settings, &file);
    }
}

/// Remembers the files that the saved graph names, and those that its model was read from, so that it may open them the
/// next time. It may be in another folder now, or have been opened with files that only the command line trusted.
pub(super) fn remember_named(documents: &mut Documents, settings: &mut Settings, evaluation: &Evaluation) {
    let named = missing_files::named(&documents.document);
    let model = evaluation.model.received.as_ref();
    let of_model = model.into_iter().flat_map(|model| {
        let files = &model.linked.model.files;
        let beside = files.first().map(|file| PathBase::of_file(file));
        let is_beside = move |file: &&PathBuf| beside.as_ref().is_some_and(|beside| beside.is_above(file));
        files.iter().filter(move |file| !is_beside(file)).cloned()
    });
    // The loaded model may be a substitute for one that was not found.
    let has_own_model = evaluation.model.loaded().1 && evaluation.model.refused().is_none();
    let of_model: Vec<PathBuf> = of_model.filter(|_| has_own_model).collect();
    for file in named.into_iter().chain(of_model) {
        remember_file(documents, settings, &file);
    }
}

/// Remembers a file that the graph names, unless it may open it without that.
pub(super) fn remember_file(documents: &mut Documents, settings: &mut Settings, file: &Path) {
    if !opens_again(documents, settings, file) {
        trust_path(documents, settings, file);
    }
}

/// Returns whether the folder of the graph and the settings alone allow the graph to open a file.
fn opens_again(documents: &Documents, settings: &Settings, file: &Path) -> bool {
    let place = documents.document.session.file();
    let by_place = place.is_some_and(|place| TrustedPaths::of_file(place).contains(file));
    let own = documents.folders.trusted();
    let kept = own.chain(&settings.trusted);
    let kept = kept.fold(TrustedPaths::default(), |trusted, path| trusted.with_path(path));
    by_place || kept.contains(file)
}
