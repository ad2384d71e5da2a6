//! What holds for all of a graph: how finely it is worked on, what its lengths are of, and its seed.

use sabi_graph::{Edit, Fit, Preview};

use crate::open_document::OpenDocument;

/// Texels along a side of one texture while the graph is worked on.
pub fn set_size(document: &mut OpenDocument, size: u32) -> bool {
    let known = document.contents().preview.clone();
    let preview = Preview {
        size: Some(size),
        ..known.unwrap_or_default()
    };
    let edit = Edit::SetPreview { preview: Some(preview) };
    document.edit(&format!("Work at {size} texels"), vec![edit])
}

/// What counts as length 1 on the model.
pub fn set_fit(document: &mut OpenDocument, fit: Fit) -> bool {
    document.edit("Change what a length of 1 is", vec![Edit::SetFit { fit }])
}

/// What all random patterns begin with.
pub fn set_seed(document: &mut OpenDocument, seed: u32) -> bool {
    document.edit("Change the graph's seed", vec![Edit::SetSeed { seed }])
}
