//! Reads files again that other programs have changed.

use std::time::Duration;

use sabi_editing::trust;

use super::documents::Documents;
use super::shell::Shell;
use crate::evaluation::Evaluation;
use crate::model_row::ModelRow;
use crate::model_view::ModelView;

/// Time until the next check whether files are watched.
const WATCH_AGAIN: Duration = Duration::from_millis(100);

/// Reads files again that have changed.
pub(super) fn follow_files(
    documents: &mut Documents,
    evaluation: &mut Evaluation,
    row: &mut ModelRow,
    model: &mut ModelView,
    shell: &mut Shell,
) {
    documents.watch(evaluation, row, model.environment.file());
    match documents.watching.take_library_reread() {
        Some(true) => documents.library.invalidate(),
        Some(false) => {}
        None => shell.context.request_repaint_after(WATCH_AGAIN),
    }
    documents.kinds_reading.take(&shell.context, &mut documents.document);
    let Some(changes) = documents.watching.changes() else {
        return;
    };
    if changes.nodes {
        let folders = trust::node_folders(&documents.document);
        documents.reread_kinds(&shell.context, &folders);
    }
    if changes.model {
        evaluation.model.reread();
    }
    row.reread(&changes.files);
    if let Some(watched) = documents.watching.watched() {
        if watched.library.iter().any(|file| changes.files.contains(file)) {
            documents.library.invalidate();
        }
        if watched.environment.iter().any(|file| changes.files.contains(file)) {
            model.environment.read_again();
        }
        if !changes.files.is_disjoint(&watched.named) {
            documents.document.files_changed(&changes.files);
        }
    }
    if changes.graph {
        let deleted = documents.check_file();
        deleted.into_iter().for_each(|sentence| shell.notify(sentence));
    }
}
