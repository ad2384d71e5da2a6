//! Documents with the paths of their files in the archive.

use std::path::Path;

use sabi_files::{PathBase, whole_path};
use sabi_graph::{Document, Preview};

use super::named_files::{NamedDocument, without_model};
use super::places::Places;
use crate::opening::linked_model::SavedReading;
use crate::session::path_rewrite::document_with_paths;

/// Folder that represents the archive in computations of paths.
const ROOT: &str = "/archive";

/// A document of the archive.
pub(super) struct RewrittenDocument {
    /// Name in the archive.
    pub(super) name: String,
    pub(super) document: Document,
    /// Text of the file: the same bytes as the original if no path changes.
    pub(super) text: String,
}

/// Preview model of the graph in the archive.
pub(super) enum ShownModel<'a> {
    /// As in its file. The preview model of a group file is not packed, and no bake needs it.
    AsWritten,
    /// This entry or no model, and the choices for reading the model.
    Interface(Option<&'a str>, &'a SavedReading),
}

/// Returns a document with the paths of its files in the archive. Paths of missing files are kept.
pub(super) fn rewritten(
    named: &NamedDocument,
    name: &str,
    places: &Places,
    model: &ShownModel<'_>,
) -> RewrittenDocument {
    let base = named.base();
    let moved = |written: &str| {
        let target = places.of(&whole_path(&base, written));
        target.map_or_else(|| written.to_owned(), |target| path_to(target, name, written))
    };
    let original = &named.open.document;
    let mut document = document_with_paths(&without_model(original), &|written| match written.trim().is_empty() {
        true => written.to_owned(),
        false => moved(written),
    });
    let shown = original.preview.as_ref().and_then(|preview| preview.mesh.as_deref());
    let builtin = original
        .preview
        .as_ref()
        .and_then(|preview| preview.builtin_mesh().and(preview.mesh.clone()));
    let mesh = match model {
        ShownModel::AsWritten => shown.map(str::to_owned),
        ShownModel::Interface(Some(entry), _) => Some(path_to(entry, name, shown.unwrap_or(""))),
        ShownModel::Interface(None, _) => builtin,
    };
    if mesh.is_some() || document.preview.is_some() {
        let preview = document.preview.get_or_insert_with(Preview::default);
        preview.mesh = mesh;
        if let ShownModel::Interface(_, reading) = model {
            // The model finds its files in the archive at the paths that it names.
            reading.put_into(preview, None);
        }
    }
    let text = match document == *original {
        true => named.open.text.to_string(),
        false => document.to_json(),
    };
    RewrittenDocument {
        name: name.to_owned(),
        document,
        text,
    }
}

/// Returns the path to an entry, for the document of this name: the written path, if it leads to the entry.
fn path_to(target: &str, name: &str, written: &str) -> String {
    if entry_of(name, written).as_deref() == Some(target) {
        return written.to_owned();
    }
    let root = Path::new(ROOT);
    let path = PathBase::of_file(&root.join(name)).write(&root.join(target));
    // Names of entries are texts.
    path.unwrap_or_else(|_| target.to_owned())
}

/// Returns the name of the entry to which a path in the document of this name leads; `None` if it leads out of the archive.
pub(super) fn entry_of(name: &str, written: &str) -> Option<String> {
    let root = Path::new(ROOT);
    let base = PathBase::of_file(&root.join(name));
    let whole = base.rewrite_absolute(written).ok()?;
    let below = whole.strip_prefix(ROOT)?.strip_prefix('/')?;
    Some(below.to_owned())
}
