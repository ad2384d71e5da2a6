//! What is not saved is kept every few seconds in case the program ends, and so are settings.

use std::time::{Duration, Instant};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::{NodeDraft, Session};

use super::Editor;

/// How often what is not saved is kept in case the program ends.
const KEEP_EVERY: Duration = Duration::from_secs(3);

/// What is not saved is kept in case the program ends: when last, and what then.
pub(super) struct Keeping {
    at: Instant,
    /// The states of the graph and of node files that were kept.
    pub(super) kept: Option<(u64, u64)>,
    pub(super) every: Duration,
    /// Settings that could not be kept, which was said: the next ones are tried.
    failed: Option<serde_json::Value>,
}

impl Default for Keeping {
    fn default() -> Keeping {
        Keeping {
            at: Instant::now(),
            kept: None,
            every: KEEP_EVERY,
            failed: None,
        }
    }
}

impl Editor {
    /// Keeps what is not saved, and settings that changed.
    pub(super) fn keep(&mut self, context: &Context) {
        let now = Some((self.document.session.revision(), self.panels.page.revision()));
        if self.keeping.at.elapsed() >= self.keeping.every {
            self.keeping.at = Instant::now();
            self.keeping.kept = now;
            if let Err(error) = self.document.session.keep(&self.panels.page.unsaved()) {
                self.keeping.kept = None;
                self.say(format!("What is not saved cannot be kept in case of a crash: {error}"));
            }
            self.keep_settings();
        }
        if self.keeping.kept != now {
            context.request_repaint_after(self.keeping.every);
        }
    }

    /// Makes sure that what is unsaved is kept although nothing was edited.
    pub(crate) fn keep_soon(&mut self) {
        self.keeping.kept = None;
    }

    /// The work, with nothing in its place: the window is about to end.
    pub(super) fn take_document(&mut self) -> OpenDocument {
        std::mem::replace(&mut self.document, OpenDocument::new(Session::new(None)))
    }

    /// Closes the document as the window ends. Unsaved changes that were not discarded are kept: systems end programs
    /// without asking them.
    pub(super) fn end_work(&mut self) {
        let mut document = self.take_document();
        let drafts = self.panels.page.unsaved();
        if self.files.may_close || !document.session.is_dirty() && drafts.is_empty() {
            document.session.close();
        } else {
            keep_at_last(&mut document, &drafts);
        }
    }

    pub(super) fn keep_settings(&mut self) {
        self.remember_export();
        self.settings.layout = Some(self.layout.clone());
        self.settings.view = self.model_view.choices();
        let Some(folder) = self.folders.settings.clone() else {
            return;
        };
        let now = self.settings.to_json();
        if now == self.kept_settings || self.keeping.failed.as_ref() == Some(&now) {
            return;
        }
        match self.settings.save(&folder, &self.kept_settings) {
            Ok(()) => self.kept_settings = now,
            Err(why) => {
                self.keeping.failed = Some(now);
                self.say(why);
            }
        }
    }
}

/// Keeps what is not saved, where no window is left to say that it cannot be.
pub(super) fn keep_at_last(document: &mut OpenDocument, drafts: &[NodeDraft]) {
    // No hand holds anything any more.
    document.session.end();
    if let Err(error) = document.session.keep(drafts) {
        tracing::error!("what is not saved cannot be kept: {error}");
    }
}
