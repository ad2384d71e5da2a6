//! Groups: grouping, ungrouping and names.

mod grouping;
mod ungrouping;

use sabi_graph::{Body, Edit};

use crate::names::{free_name, is_file};
use crate::open_document::OpenDocument;

pub use grouping::make;
pub use ungrouping::dissolve_selected;

/// Returns the name of the shown graph: that of the document, which may be empty, or that of the group.
pub fn graph_name(document: &OpenDocument) -> String {
    match document.shown() {
        Body::Main => document.contents().name.clone(),
        Body::Group(name) => {
            let group = document.contents().groups.get(name);
            group
                .and_then(|group| group.name.clone())
                .unwrap_or_else(|| name.clone())
        }
    }
}

/// Renames the shown graph: the document, or the group.
pub fn rename_graph(document: &mut OpenDocument, to: &str) -> bool {
    match document.body() {
        Body::Main => {
            let name = to.trim().to_owned();
            document.edit("Rename graph", vec![Edit::RenameDocument { name }])
        }
        Body::Group(name) => rename(document, &name, to),
    }
}

/// Renames a group, and the references in all its instances.
pub fn rename(document: &mut OpenDocument, name: &str, to: &str) -> bool {
    let to = to.trim();
    if is_file(to) {
        return document.refuse(format!(
            "'{to}' is the name of a file; choose one that does not end in .sabi"
        ));
    }
    let edit = Edit::RenameGroup {
        name: name.to_owned(),
        to: to.to_owned(),
        shown: None,
    };
    document.edit("Rename group", vec![edit])
}

/// Returns a name that no group has yet.
pub(crate) fn free_name_for(document: &OpenDocument, stem: &str) -> String {
    free_name(stem, ' ', |name| document.contents().groups.contains_key(name))
}
