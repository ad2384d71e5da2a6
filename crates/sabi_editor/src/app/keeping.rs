//! What is not saved is kept every few seconds in case the program ends, and so are settings.

use std::time::{Duration, Instant};

use egui::Context;

use super::Editor;

/// How often what is not saved is kept in case the program ends.
const KEEP_EVERY: Duration = Duration::from_secs(3);

/// What is not saved is kept in case the program ends: when last, and what then.
pub(super) struct Keeping {
    at: Instant,
    /// The states of the graph and of node files that were kept.
    pub(super) kept: Option<(u64, u64)>,
    pub(super) every: Duration,
}

impl Default for Keeping {
    fn default() -> Keeping {
        Keeping {
            at: Instant::now(),
            kept: None,
            every: KEEP_EVERY,
        }
    }
}

impl Editor {
    /// Keeps what is not saved, and settings that changed.
    pub(super) fn keep(&mut self, context: &Context) {
        let now = Some((self.desk.session.revision(), self.panels.page.revision()));
        if self.keeping.at.elapsed() >= self.keeping.every {
            self.keeping.at = Instant::now();
            self.keeping.kept = now;
            if let Err(error) = self.desk.session.keep(&self.panels.page.unsaved()) {
                self.keeping.kept = None;
                self.say(format!("What is not saved cannot be kept in case of a crash: {error}"));
            }
            self.keep_settings();
        }
        if self.keeping.kept != now {
            context.request_repaint_after(self.keeping.every);
        }
    }

    pub(super) fn keep_settings(&mut self) {
        self.remember_export();
        self.settings.layout = Some(self.layout.clone());
        self.settings.view = self.model_view.choices();
        let Some(folder) = self.folders.settings.clone() else {
            return;
        };
        let text = serde_json::to_string(&self.settings).ok();
        if text == self.kept_settings {
            return;
        }
        self.kept_settings = text;
        if let Err(why) = self.settings.save(&folder) {
            self.say(why);
        }
    }
}
