//! Accessors of the window's owners, for short tests.

use std::path::PathBuf;

use egui::TextureId;
use sabi_engine::baking::BakeRequest;
use sabi_engine::live::ViewSubject;
use sabi_graph::{NodeId, NodeRef};

use super::{Editor, ProgramFolders};
use crate::exports::ExportSource;
use crate::shown_results::result_of;

impl Editor {
    /// Returns the subject that the model view shows.
    pub(super) fn seen(&self) -> ViewSubject {
        self.looks.on_model(&self.documents.document, &self.shell.settings)
    }

    /// Result of a node at the output that was chosen last.
    pub(super) fn chosen(&self, id: &NodeId) -> NodeRef {
        self.looks.chosen(&self.documents.document, id)
    }

    /// Result of a node at an output.
    pub(super) fn reference(&self, id: &NodeId, port: Option<String>) -> NodeRef {
        result_of(&self.documents.document, id, port)
    }

    /// Picture of a node's result.
    pub(super) fn thumbnail_of(&self, id: &NodeId) -> Option<TextureId> {
        self.picture_of(&self.chosen(id))
    }

    /// Picture of a result.
    pub(super) fn picture_of(&self, result: &NodeRef) -> Option<TextureId> {
        self.evaluation.results.thumbnail(result).map(egui::TextureHandle::id)
    }

    /// Number of errors.
    pub(super) fn problem_count(&self) -> usize {
        self.evaluation.problem_count() + self.documents.document.node_kinds().kinds.faults.len()
    }

    /// Shows a node's result.
    pub(super) fn look_at(&mut self, id: &NodeId, port: Option<String>) {
        self.looks.show(&self.documents.document, id, port);
    }

    /// Keeps a node's result in the 2D view, or releases it.
    pub(super) fn pin(&mut self, id: &NodeId) {
        self.looks.toggle_pin_2d(&self.documents.document, id);
    }

    /// Returns whether only the model and the exposed parameters are shown.
    pub(super) fn is_use_view(&self) -> bool {
        self.shell.dock.is_use_view()
    }

    pub(super) fn folders(&self) -> &ProgramFolders {
        &self.documents.folders
    }

    /// Request of an export to a folder.
    pub(super) fn bake_request(&self, output: PathBuf, force: bool) -> BakeRequest {
        let source = ExportSource {
            document: &self.documents.document,
            evaluation: &self.evaluation,
            choices: &self.shell.settings.export,
        };
        source.request(output, force)
    }
}
