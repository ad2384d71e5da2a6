//! Files of groups and of nodes that other graphs can use.

use sabi_editing::library;
use sabi_engine::catalog::node_file::NodeDraft;

use super::documents::Documents;
use super::shell::Shell;
use super::trust;
use crate::action::LibraryKind;
use crate::evaluation::Evaluation;
use crate::panels::node_page::NodePage;
use crate::saved_pictures::OF_GROUP;
use crate::shown_results::result_of;

/// Puts the selected group into a library, with the picture of its result.
pub(super) fn save_to_library(
    documents: &mut Documents,
    evaluation: &Evaluation,
    shell: &mut Shell,
    library: LibraryKind,
) {
    let Some(folder) = documents.library_folder(library) else {
        return shell.notify(match library {
            LibraryKind::Project => "Save the graph first, so that there is a folder beside it.",
            LibraryKind::User | LibraryKind::Sabi => "This system has no folder for a library.",
        });
    };
    let picture = documents.document.selected_one().and_then(|id| {
        let result = result_of(&documents.document, id, None);
        evaluation.results.thumbnail_pixels(&result).cloned()
    });
    let Some(file) = library::save_group(&mut documents.document, &folder) else {
        return;
    };
    documents.library.invalidate();
    if let Some(picture) = picture {
        let stored = documents.pictures.store(&shell.context, &file, OF_GROUP, &picture);
        shell.report(stored);
    }
}

/// Writes the file of a node, and adds the node to those that can be added.
pub(super) fn save_node(documents: &mut Documents, shell: &mut Shell, page: &mut NodePage, node: &NodeDraft) {
    let NodeDraft { folder, id, .. } = node;
    if let Some(file) = shell.report(node.save(documents.document.session.disk())) {
        shell.notify(format!(
            "'{id}' is in {}, and among the nodes that can be added.",
            file.display()
        ));
        trust::trust_nodes(documents, shell, folder);
        page.saved(node);
    }
}
