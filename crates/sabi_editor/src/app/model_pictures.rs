//! Pictures of variants and graphs, kept once the model shows one at rest.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_editing::variants;
use sabi_engine::live::ViewSubject;

use super::documents::Documents;
use super::shell::Shell;
use crate::dock::Panel;
use crate::evaluation::Evaluation;
use crate::model_view::ModelView;
use crate::saved_pictures::OF_GRAPH;
use crate::shown_results::ShownResults;

/// Time without a new picture after which the model is at rest.
const REST: Duration = Duration::from_millis(400);

/// The model as it looks now, as a picture of the open graph or of one of its variants.
pub(crate) struct ModelPictures<'a> {
    pub(super) documents: &'a mut Documents,
    pub(super) evaluation: &'a Evaluation,
    pub(super) looks: &'a ShownResults,
    pub(super) shell: &'a mut Shell,
    pub(super) model: &'a ModelView,
}

/// Shown variant whose picture is awaited.
#[derive(Default)]
pub(super) struct AwaitedPicture {
    /// Text that identifies the variant.
    what: String,
    /// Number of pictures that were drawn before it was shown.
    drawn_before: u64,
    /// Number of pictures that were drawn so far, and when the last one was noticed.
    last: Option<(u64, Instant)>,
}

impl ModelPictures<'_> {
    /// Returns whether the model shows the graph's outputs while nothing is being evaluated or drawn.
    fn shows_outputs_at_rest(&self) -> bool {
        let document = &self.documents.document;
        let is_at_work = self.evaluation.is_busy() || self.documents.is_dragging;
        let has_failed = self.evaluation.failure.is_some() || self.evaluation.model.failure.is_some();
        let subject = self.looks.on_model(document, &self.shell.settings);
        !is_at_work && !has_failed && subject == ViewSubject::Outputs && self.shell.dock.is_shown(Panel::Viewport)
    }

    /// Stores the model as it looks now as the picture of a graph, for the start page.
    pub(super) fn store_of_graph(&mut self, file: &Path) {
        if !self.shows_outputs_at_rest() {
            return;
        }
        if let Some(picture) = self.model.pictures.shown(self.evaluation.gpu()) {
            let stored = self
                .documents
                .pictures
                .store(&self.shell.context, file, OF_GRAPH, &picture);
            self.shell.report(stored);
        }
    }

    /// Stores the model as it looks now as the picture of a variant.
    pub(super) fn store_of_variant(&mut self, name: &str) {
        let documents = &mut *self.documents;
        let values = documents.document.graph().variants().get(name);
        let Some((picture, values)) = self.model.pictures.shown(self.evaluation.gpu()).zip(values) else {
            return;
        };
        let file = documents.document.session.file().unwrap_or(Path::new(""));
        let text = variants::as_text(&documents.document, values);
        let stored = documents.pictures.store(&self.shell.context, file, &text, &picture);
        self.shell.report(stored);
    }
}

impl AwaitedPicture {
    /// Keeps the picture of the variant that is shown, or of the graph's own values, if there is none yet.
    pub(super) fn keep(&mut self, pictures: &mut ModelPictures<'_>, context: &Context) {
        let document = &pictures.documents.document;
        if document.graph().variants().is_empty() {
            return;
        }
        let what = variants::shown_as_text(document);
        let drawn = pictures.model.pictures.drawn;
        if self.what != what {
            *self = AwaitedPicture {
                what,
                drawn_before: drawn,
                last: None,
            };
            return;
        }
        // An earlier picture may be of another variant.
        if !pictures.shows_outputs_at_rest() || drawn == self.drawn_before {
            self.last = None;
            return;
        }
        let file = document.session.file().unwrap_or(Path::new("")).to_owned();
        if pictures.documents.pictures.find(context, &file, &what).is_some() {
            return;
        }
        match self.last {
            Some((last, since)) if last == drawn => {
                if since.elapsed() < REST {
                    return;
                }
                if let Some(picture) = pictures.model.pictures.shown(pictures.evaluation.gpu()) {
                    let stored = pictures.documents.pictures.store(context, &file, &what, &picture);
                    pictures.shell.report(stored);
                }
            }
            _ => {
                self.last = Some((drawn, Instant::now()));
                context.request_repaint_after(REST);
            }
        }
    }
}
