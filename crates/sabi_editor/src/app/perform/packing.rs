//! Packs the graph with all files that it uses.

use std::path::PathBuf;

use sabi_engine::packing::{PackRequest, PackedModel};

use crate::app::Editor;

impl Editor {
    /// Asks for the archive to write. The graph has to be saved first, since it is packed from its file.
    pub(super) fn ask_to_pack(&mut self) {
        if self.packing.is_running() {
            self.shell.notify("The graph is being packed already.");
        } else if self.is_saved() {
            self.views.questions.ask_for_archive(&self.documents.document);
        }
    }

    /// Packs the graph and the shown model into an archive.
    pub(in crate::app) fn pack_into(&mut self, output: PathBuf) {
        let file = self.documents.document.session.file().map(ToOwned::to_owned);
        let Some(graph) = file.filter(|_| self.is_saved()) else {
            return;
        };
        let model = self.evaluation.model.file().to_owned();
        let request = PackRequest {
            graph,
            model: PackedModel::File(model),
            reading: self.evaluation.model.import_options().saved(),
            output,
            // The notice at the end lists missing files.
            allows_missing: true,
            // The dialog has asked before it accepts the name of an existing file.
            replaces: true,
            trusted: self.documents.document.session.graph().trusted.clone(),
        };
        self.packing.start(&self.shell.context, request);
        self.shell.notify("Packing the graph with all files that it uses…");
    }

    /// Returns whether the graph has a file and no unsaved changes; if not, asks the user to save it.
    fn is_saved(&mut self) -> bool {
        let session = &mut self.documents.document.session;
        let is_saved = session.file().is_some() && !session.is_dirty();
        if !is_saved {
            self.shell.notify("Save the graph first: it is packed from its file.");
        }
        is_saved
    }
}
