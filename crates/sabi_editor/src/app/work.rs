//! What is worked on in a window from its first frame on.

use std::path::PathBuf;

use sabi_editing::OpenDocument;
use sabi_engine::Session;

use super::Handover;
use crate::canvas::Canvas;
use crate::files::Files;
use crate::panels::page::Draft;

const NOT_WRITTEN: &str = "The textures were not written, since the graphics device was lost; export them again.";

/// What is worked on.
pub(super) struct Work {
    pub(super) document: OpenDocument,
    pub(super) canvas: Canvas,
    pub(super) model: PathBuf,
    pub(super) files: Files,
    pub(super) drafts: Vec<Draft>,
    /// What did not outlive the window before.
    pub(super) fault: Option<String>,
}

impl Work {
    /// What a window on a lost device left, or else a beginning with the questions that belong to one.
    pub(super) fn taken_up(
        session: Session,
        model: PathBuf,
        handover: &Handover,
        files: impl FnOnce() -> Files,
    ) -> Work {
        let kept = handover.lock().ok().and_then(|mut kept| kept.take());
        match kept {
            // Who was at work goes on, without a start page before it.
            Some(kept) => Work {
                document: kept.document,
                canvas: kept.canvas,
                model: kept.model,
                files: Files::new(false, None),
                drafts: kept.drafts,
                fault: kept.was_exporting.then(|| NOT_WRITTEN.to_owned()),
            },
            None => Work {
                document: OpenDocument::new(session),
                canvas: Canvas::default(),
                model,
                files: files(),
                drafts: Vec::new(),
                fault: None,
            },
        }
    }
}
