//! Settings of a whole graph: texture size while editing, unit of length, and seed.

use sabi_graph::{Edit, Fit, Preview, SavedView};

use crate::open_document::OpenDocument;

/// Sets the size in texels of the textures that are used while the graph is edited.
pub fn set_size(document: &mut OpenDocument, size: u32) -> bool {
    let edit = changed_preview(document, |preview| preview.size = Some(size));
    document.edit(&format!("Work at {size} texels"), vec![edit])
}

/// Saves a view of the model under a name.
pub fn keep_view(document: &mut OpenDocument, name: String, view: SavedView) -> bool {
    let step = format!("Save view '{name}'");
    let edit = changed_preview(document, |preview| {
        preview.views.insert(name, view);
    });
    document.edit(&step, vec![edit])
}

/// Deletes a saved view of the model.
pub fn forget_view(document: &mut OpenDocument, name: &str) -> bool {
    let edit = changed_preview(document, |preview| {
        preview.views.remove(name);
    });
    document.edit(&format!("Delete view '{name}'"), vec![edit])
}

/// Returns an edit that changes some settings of the preview and keeps the others.
pub fn changed_preview(document: &OpenDocument, change: impl FnOnce(&mut Preview)) -> Edit {
    // A document without preview settings has defaults for all of them.
    let mut preview = document.contents().preview.clone().unwrap_or_default();
    change(&mut preview);
    Edit::SetPreview { preview: Some(preview) }
}

/// Sets the length that counts as 1 on the model.
pub fn set_fit(document: &mut OpenDocument, fit: Fit) -> bool {
    document.edit("Change the unit of length", vec![Edit::SetFit { fit }])
}

/// Sets the seed of the graph, from which all random patterns are derived.
pub fn set_seed(document: &mut OpenDocument, seed: u32) -> bool {
    document.edit("Change the graph's seed", vec![Edit::SetSeed { seed }])
}
