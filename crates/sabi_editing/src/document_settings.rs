//! Settings of a whole graph: texture size while editing, unit of length, and seed.

use sabi_graph::{Edit, Fit, Preview};

use crate::open_document::OpenDocument;

/// Sets the texels along a side of a texture while the graph is edited.
pub fn set_size(document: &mut OpenDocument, size: u32) -> bool {
    let edit = changed_preview(document, |preview| preview.size = Some(size));
    document.edit(&format!("Work at {size} texels"), vec![edit])
}

/// Edit that changes settings of the preview, and leaves the others.
pub fn changed_preview(document: &OpenDocument, change: impl FnOnce(&mut Preview)) -> Edit {
    // A document without preview settings sets none of the others.
    let mut preview = document.contents().preview.clone().unwrap_or_default();
    change(&mut preview);
    Edit::SetPreview { preview: Some(preview) }
}

/// Sets the length that counts as 1 on the model.
pub fn set_fit(document: &mut OpenDocument, fit: Fit) -> bool {
    document.edit("Change what a length of 1 is", vec![Edit::SetFit { fit }])
}

/// Sets the seed of the graph, from which all random patterns are derived.
pub fn set_seed(document: &mut OpenDocument, seed: u32) -> bool {
    document.edit("Change the graph's seed", vec![Edit::SetSeed { seed }])
}
