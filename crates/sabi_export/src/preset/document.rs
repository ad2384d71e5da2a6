//! Documents beside the maps of a preset.

use serde::{Deserialize, Serialize};

use super::Format;

/// Document with a material for each material of the model, which names the maps of a preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Document {
    /// MaterialX with `gltf_pbr` and `open_pbr_surface`.
    MaterialX,
    /// USD as text, with UsdPreviewSurface.
    Usda,
    /// USD with its maps in one file.
    Usdz,
}

impl Document {
    /// Name in preset files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Document::MaterialX => "materialx",
            Document::Usda => "usda",
            Document::Usdz => "usdz",
        }
    }

    /// Ending of file names.
    pub fn ending(self) -> &'static str {
        match self {
            Document::MaterialX => "mtlx",
            Document::Usda => "usda",
            Document::Usdz => "usdz",
        }
    }

    /// Its content, in a line.
    pub fn about(self) -> &'static str {
        match self {
            Document::MaterialX => "materials for gltf_pbr and open_pbr_surface",
            Document::Usda => "materials for UsdPreviewSurface",
            Document::Usdz => "the same with its PNG maps in one file",
        }
    }

    /// Returns true if the document may name maps of this format.
    pub(crate) fn takes(self, format: Format) -> bool {
        match self {
            Document::MaterialX | Document::Usda => true,
            // Readers of Apple take no OpenEXR, and the specification of USDZ no TGA.
            Document::Usdz => matches!(format, Format::Png { .. }),
        }
    }
}
