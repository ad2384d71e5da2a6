//! State that views read while a frame is drawn, and the trait that all views implement.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{TextureHandle, TextureId, Ui};
use sabi_editing::{OpenDocument, node_paths};
use sabi_engine::Warning;
use sabi_engine::session::Recovery;
use sabi_graph::{LibrarySource, NodeId, NodeRef};

use crate::action::Action;
use crate::brush_shelf::BrushShelf;
use crate::builtin_models::model_of;
use crate::choice_previews::ChoicePreviews;
use crate::evaluation::Evaluation;
use crate::exports::Exports;
use crate::key_map::KeyMap;
use crate::knobs::LengthUnits;
use crate::library::GroupLibrary;
use crate::model_row::ModelRow;
use crate::paths::canonical_if_present;
use crate::pen::Pens;
use crate::saved_pictures::SavedPictures;
use crate::search::Candidate;
use crate::settings::Settings;
use crate::shown_results::ShownResults;
use crate::theme::Theme;

/// Part of the window. It owns its state, reads the context, and returns actions.
pub(crate) trait View {
    /// Draws the view and returns the requested actions.
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action>;
}

/// State that views read while a frame is drawn.
#[derive(Clone, Copy)]
pub(crate) struct ViewContext<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) evaluation: &'a Evaluation,
    /// Models beside the main one.
    pub(crate) row: &'a ModelRow,
    /// Models on the strip above the viewport.
    pub(crate) models: &'a [PathBuf],
    /// Folder of Sabi's own models, written when they are used.
    pub(crate) examples: Option<&'a Path>,
    pub(crate) looks: &'a ShownResults,
    pub(crate) exports: &'a Exports,
    pub(crate) library: &'a GroupLibrary,
    pub(crate) pictures: &'a SavedPictures,
    /// Brushes that are kept.
    pub(crate) brushes: &'a BrushShelf,
    /// Pictures of variants and effects that can be chosen, on the open model.
    pub(crate) choice_previews: &'a ChoicePreviews,
    /// Nodes and groups that can be added.
    pub(crate) candidates: &'a [Candidate],
    /// Graphs and node files that were not saved when the program ended.
    pub(crate) recoveries: &'a [Recovery],
    pub(crate) settings: &'a Settings,
    pub(crate) theme: &'a Arc<Theme>,
    pub(crate) keys: &'a KeyMap,
    /// Device that the window is drawn with; `None` if it is only laid out.
    pub(crate) render: Option<&'a RenderState>,
    /// Times of the last frames, without the drawing by the device.
    pub(crate) frame_times: &'a VecDeque<Duration>,
    /// Pictures of the model that were drawn so far.
    pub(crate) pictures_drawn: u64,
    /// Pens of graphics tablets.
    pub(crate) pens: &'a Pens,
    /// True if the open graph has changes that its file does not have.
    pub(crate) is_dirty: bool,
    /// True if another program has changed the graph's file, and the user has not chosen yet which version to keep.
    pub(crate) is_file_foreign: bool,
    /// True if the user wants no question about the node files beside the open graph.
    pub(crate) leaves_nodes: bool,
    /// True if only the model and the exposed parameters are shown.
    pub(crate) is_use_view: bool,
    /// True while a parameter is dragged.
    pub(crate) is_dragging: bool,
}

impl ViewContext<'_> {
    /// File of the open graph; empty while it has none.
    pub(crate) fn file_or_empty(&self) -> &Path {
        self.document.session.file().unwrap_or(Path::new(""))
    }

    /// Units of lengths on the model that is shown.
    pub(crate) fn lengths(&self) -> LengthUnits {
        LengthUnits::on(self.evaluation.model.received.as_deref())
    }

    /// Sentence in which nodes have their titles in place of their ids.
    pub(crate) fn said(&self, sentence: &str) -> String {
        node_paths::with_titles(self.document, sentence)
    }

    /// Picture of a node's result, if it has arrived.
    pub(crate) fn node_picture(&self, id: &NodeId) -> Option<TextureId> {
        self.result_picture(&self.looks.chosen(self.document, id))
    }

    /// Picture of a result, if it has arrived.
    pub(crate) fn result_picture(&self, result: &NodeRef) -> Option<TextureId> {
        self.evaluation.results.thumbnail(result).map(TextureHandle::id)
    }

    /// Returns whether the library shows effects on the open model.
    pub(crate) fn tries_effects(&self) -> bool {
        self.settings.tries_effects.unwrap_or(true)
    }

    /// Linked groups of the document whose library has another version.
    pub(crate) fn outdated_groups(&self) -> Vec<String> {
        let groups = self.document.contents().groups.iter();
        let is_outdated = |source: &LibrarySource| {
            let digest = self.library.digest(self.document, source);
            digest.is_some_and(|digest| digest != source.digest)
        };
        let outdated = groups.filter(|(_, group)| group.library.as_ref().is_some_and(is_outdated));
        outdated.map(|(name, _)| name.clone()).collect()
    }

    /// Number of errors, without warnings.
    pub(crate) fn problem_count(&self) -> usize {
        let named_model = usize::from(self.is_named_model_refused());
        self.evaluation.problem_count() + self.document.node_kinds().kinds.faults.len() + named_model
    }

    /// Returns whether another model is shown because the model that the graph names could not be read.
    pub(crate) fn is_named_model_refused(&self) -> bool {
        let refused = self.evaluation.model.refused().map(canonical_if_present);
        let named = model_of(&self.document.session, self.examples).and_then(Result::ok);
        refused.is_some() && refused == named.as_deref().map(canonical_if_present)
    }

    /// Number of warnings: about the graph, the model, and the models beside it.
    pub(crate) fn warning_count(&self) -> usize {
        let beside = self.row.beside().iter();
        let of_beside: usize = beside.map(|evaluation| evaluation.model.warnings().len()).sum();
        self.warnings().count() + of_beside
    }

    /// Warnings of the last evaluation, and those about a model that was received since.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = &Warning> {
        let known = &self.evaluation.faults.all.warnings;
        let of_model = self.evaluation.model.warnings().iter();
        known.iter().chain(of_model.filter(|warning| !known.contains(warning)))
    }

    /// Sentence about why the outputs do not show the graph as it is.
    pub(crate) fn fault_of_outputs(&self) -> Option<String> {
        let evaluation = self.evaluation;
        let outputs = self.document.contents().graph.nodes();
        let mut outputs = outputs.filter(|(_, node)| node.kind.starts_with("output/"));
        let failure = evaluation.model.failure.as_ref().or(evaluation.failure.as_ref());
        let failure = failure.map(ToString::to_string);
        let fault = failure.or_else(|| {
            outputs
                .find_map(|(id, _)| evaluation.faults.sentence(id.as_str()))
                .cloned()
        });
        fault.map(|sentence| self.said(&sentence))
    }
}
