//! What holds for all of a graph: how finely it is worked on, what its lengths are of, and its seed.

use sabi_graph::{Edit, Fit, Preview};

use super::OpenDocument;

impl OpenDocument {
    /// Texels along a side of one texture while the graph is worked on.
    pub fn set_size(&mut self, size: u32) -> bool {
        let known = self.contents().preview.clone();
        let preview = Preview {
            size: Some(size),
            ..known.unwrap_or_default()
        };
        let edit = Edit::SetPreview { preview: Some(preview) };
        self.edit(&format!("Work at {size} texels"), vec![edit])
    }

    /// What counts as length 1 on the model.
    pub fn set_fit(&mut self, fit: Fit) -> bool {
        self.edit("Change what a length of 1 is", vec![Edit::SetFit { fit }])
    }

    /// What all random patterns begin with.
    pub fn set_seed(&mut self, seed: u32) -> bool {
        self.edit("Change the graph's seed", vec![Edit::SetSeed { seed }])
    }
}
