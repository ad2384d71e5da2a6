//! Pictures of variants, kept once the model shows one at rest.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_editing::variants;
use sabi_engine::ViewSubject;

use super::Editor;

/// Time without a new picture after which the model is at rest.
const REST: Duration = Duration::from_millis(400);

/// Variant whose picture is kept once no other one has been drawn for a while.
pub(super) struct AwaitedPicture {
    /// Text that identifies the variant.
    what: String,
    /// Number of pictures that were drawn so far.
    drawn: u64,
    since: Instant,
}

impl Editor {
    /// Keeps the picture of the variant that is shown, or of the graph's own values, if there is none yet.
    pub(super) fn keep_picture_of_variant(&mut self, context: &Context) {
        let document = &self.documents.document;
        let is_at_work =
            self.evaluation.is_busy() || self.documents.is_dragging || document.graph().variants().is_empty();
        if is_at_work || self.looks.on_model(document, &self.shell.settings) != ViewSubject::Outputs {
            self.awaited_picture = None;
            return;
        }
        let what = variants::shown_as_text(document);
        let file = document.session.file().unwrap_or(Path::new("")).to_owned();
        if self.documents.pictures.find(context, &file, &what).is_some() {
            self.awaited_picture = None;
            return;
        }
        let drawn = self.views.model.pictures.drawn;
        match &self.awaited_picture {
            Some(awaited) if awaited.what == what && awaited.drawn == drawn => {
                if awaited.since.elapsed() < REST {
                    return;
                }
                self.awaited_picture = None;
                if let Some(picture) = self.views.model.pictures.shown(self.evaluation.gpu()) {
                    let stored = self.documents.pictures.store(context, &file, &what, &picture);
                    self.shell.report(stored);
                }
            }
            _ => {
                let since = Instant::now();
                self.awaited_picture = Some(AwaitedPicture { what, drawn, since });
                context.request_repaint_after(REST);
            }
        }
    }
}
