//! Recovery of work that was not saved when a program ended, even if that program is still ending.

use std::time::Duration;

use egui::Context;
use sabi_engine::session::is_open_in_a_window;

use super::documents::Documents;
use super::shell::Shell;
use crate::files::{Question, Questions};
use crate::views::Views;

/// Time between two checks whether the graph's file is still open in another window.
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// Notice about unsaved work that was found after the open graph was changed.
const FOUND: &str = "There is unsaved work from before. It is on the start page: File, Examples…";

/// Offers unsaved work on the open graph's file. For other unsaved work, opens the start page or shows a notice.
pub(super) fn follow_recoveries(documents: &mut Documents, views: &mut Views, shell: &mut Shell, context: &Context) {
    claim_file_again(documents, &mut views.questions, shell, context);
    let is_new = documents.recoveries.take_freed(context);
    if is_new && documents.recovery_of_open_graph().is_none() {
        if documents.document.session.is_dirty() {
            // The start page would cover work that was begun meanwhile.
            shell.notify(FOUND);
        } else {
            views.start.is_open = true;
        }
    }
    let is_asked = views.questions.open.is_some() || views.start.is_open;
    if is_asked || !std::mem::take(&mut documents.recoveries.is_offer_due) {
        return;
    }
    if let Some(at) = documents.recovery_of_open_graph() {
        views.questions.open = Some(Question::Recover { at });
    }
}

/// While the question about a file that is open elsewhere is shown: claims the file as soon as no other window has
/// it open. A killed program holds its file until the system has ended it.
fn claim_file_again(documents: &mut Documents, questions: &mut Questions, shell: &mut Shell, context: &Context) {
    let Some(Question::OpenElsewhere { file }) = &questions.open else {
        return;
    };
    context.request_repaint_after(LOOK_AGAIN);
    let session = &mut documents.document.session;
    if is_open_in_a_window(file) || !session.graph_file.claim() {
        return;
    }
    session.graph_file.set_read_only(false);
    questions.open = None;
    // The other window may have saved the file before it closed.
    let deleted = documents.check_file();
    deleted.into_iter().for_each(|sentence| shell.notify(sentence));
}
