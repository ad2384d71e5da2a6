//! Reads files again that other programs have changed.

use std::time::Duration;

use sabi_editing::trust;

use super::Editor;

/// Time until the next check whether files are watched.
const WATCH_AGAIN: Duration = Duration::from_millis(100);

impl Editor {
    /// Reads files again that have changed.
    pub(super) fn follow_files(&mut self) {
        let environment = self.views.model.environment.file();
        self.documents.watch(&self.evaluation, &self.row, environment);
        match self.documents.watching.take_library_reread() {
            Some(true) => self.documents.library.invalidate(),
            Some(false) => {}
            None => self.shell.context.request_repaint_after(WATCH_AGAIN),
        }
        let documents = &mut self.documents;
        documents
            .kinds_reading
            .take(&self.shell.context, &mut documents.document);
        let Some(changes) = self.documents.watching.changes() else {
            return;
        };
        if changes.nodes {
            let folders = trust::node_folders(&self.documents.document);
            self.documents.reread_kinds(&self.shell.context, &folders);
        }
        if changes.model {
            self.evaluation.model.reread();
        }
        self.row.reread(&changes.files);
        if let Some(watched) = self.documents.watching.watched() {
            if watched.library.iter().any(|file| changes.files.contains(file)) {
                self.documents.library.invalidate();
            }
            if watched.environment.iter().any(|file| changes.files.contains(file)) {
                self.views.model.environment.read_again();
            }
            if !changes.files.is_disjoint(&watched.named) {
                self.documents.document.files_changed(&changes.files);
            }
        }
        if changes.graph {
            let deleted = self.documents.check_file();
            deleted.into_iter().for_each(|sentence| self.shell.notify(sentence));
        }
    }
}
