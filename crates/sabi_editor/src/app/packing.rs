//! Packs the graph with all files that it uses.

use std::path::PathBuf;

use sabi_engine::packing::{PackRequest, PackedModel};

use super::documents::Documents;
use super::shell::Shell;
use crate::evaluation::Evaluation;
use crate::files::Questions;
use crate::pack_task::PackTask;

/// Asks for the archive to write. The graph has to be saved first, since it is packed from its file.
pub(super) fn ask_to_pack(packing: &PackTask, documents: &mut Documents, shell: &mut Shell, questions: &mut Questions) {
    if packing.is_running() {
        shell.notify("The graph is being packed already.");
    } else if is_saved(documents, shell) {
        questions.ask_for_archive(&documents.document);
    }
}

/// Packs the graph and the shown model into an archive.
pub(super) fn pack_into(
    packing: &mut PackTask,
    documents: &mut Documents,
    evaluation: &Evaluation,
    shell: &mut Shell,
    output: PathBuf,
) {
    let file = documents.document.session.file().map(ToOwned::to_owned);
    let Some(graph) = file.filter(|_| is_saved(documents, shell)) else {
        return;
    };
    let model = evaluation.model.file().to_owned();
    let request = PackRequest {
        graph,
        model: PackedModel::File(model),
        reading: evaluation.model.import_options().saved(),
        output,
        // The notice at the end lists missing files.
        allows_missing: true,
        // The dialog has asked before it accepts the name of an existing file.
        replaces: true,
        trusted: documents.document.session.graph().trusted.clone(),
    };
    packing.start(&shell.context, request);
    shell.notify("Packing the graph with all files that it uses…");
}

/// Returns whether the graph has a file and no unsaved changes; if not, asks the user to save it.
fn is_saved(documents: &mut Documents, shell: &mut Shell) -> bool {
    let session = &mut documents.document.session;
    let is_saved = session.file().is_some() && !session.is_dirty();
    if !is_saved {
        shell.notify("Save the graph first: it is packed from its file.");
    }
    is_saved
}
