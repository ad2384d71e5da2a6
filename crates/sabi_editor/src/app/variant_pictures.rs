//! Pictures of variants and graphs, kept once the model shows one at rest.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_editing::variants;
use sabi_engine::live::ViewSubject;

use super::Editor;
use crate::dock::Panel;

/// Time without a new picture after which the model is at rest.
const REST: Duration = Duration::from_millis(400);

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

impl Editor {
    /// Returns whether the model shows the graph's outputs while nothing is being evaluated or drawn.
    pub(super) fn shows_outputs_at_rest(&self) -> bool {
        let document = &self.documents.document;
        let is_at_work = self.evaluation.is_busy() || self.documents.is_dragging;
        let has_failed = self.evaluation.failure.is_some() || self.evaluation.model.failure.is_some();
        let subject = self.looks.on_model(document, &self.shell.settings);
        !is_at_work && !has_failed && subject == ViewSubject::Outputs && self.shell.dock.is_shown(Panel::Viewport)
    }

    /// Keeps the picture of the variant that is shown, or of the graph's own values, if there is none yet.
    pub(super) fn keep_picture_of_variant(&mut self, context: &Context) {
        let document = &self.documents.document;
        if document.graph().variants().is_empty() {
            return;
        }
        let what = variants::shown_as_text(document);
        let drawn = self.views.model.pictures.drawn;
        if self.awaited_picture.what != what {
            self.awaited_picture = AwaitedPicture {
                what,
                drawn_before: drawn,
                last: None,
            };
            return;
        }
        // An earlier picture may be of another variant.
        if !self.shows_outputs_at_rest() || drawn == self.awaited_picture.drawn_before {
            self.awaited_picture.last = None;
            return;
        }
        let file = document.session.file().unwrap_or(Path::new("")).to_owned();
        if self.documents.pictures.find(context, &file, &what).is_some() {
            return;
        }
        match self.awaited_picture.last {
            Some((last, since)) if last == drawn => {
                if since.elapsed() < REST {
                    return;
                }
                if let Some(picture) = self.views.model.pictures.shown(self.evaluation.gpu()) {
                    let stored = self.documents.pictures.store(context, &file, &what, &picture);
                    self.shell.report(stored);
                }
            }
            _ => {
                self.awaited_picture.last = Some((drawn, Instant::now()));
                context.request_repaint_after(REST);
            }
        }
    }
}
