//! Documents beside the maps of a preset.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::MapFormat;

/// Document with a material for each material of the model, which names the maps of a preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DocumentFormat {
    /// MaterialX with `gltf_pbr` and `open_pbr_surface`.
    MaterialX,
    /// USD as text, with UsdPreviewSurface.
    Usda,
    /// USD with its maps in one file.
    Usdz,
}

impl DocumentFormat {
    /// Name in preset files and reports.
    pub fn name(self) -> &'static str {
        match self {
            DocumentFormat::MaterialX => "materialx",
            DocumentFormat::Usda => "usda",
            DocumentFormat::Usdz => "usdz",
        }
    }

    /// Ending of file names.
    pub fn ending(self) -> &'static str {
        match self {
            DocumentFormat::MaterialX => "mtlx",
            DocumentFormat::Usda => "usda",
            DocumentFormat::Usdz => "usdz",
        }
    }

    /// Its content, in a line.
    pub fn about(self) -> &'static str {
        match self {
            DocumentFormat::MaterialX => "materials for gltf_pbr and open_pbr_surface",
            DocumentFormat::Usda => "materials for UsdPreviewSurface",
            DocumentFormat::Usdz => "the same with its PNG maps in one file",
        }
    }

    /// Returns true if the document may name maps of this format.
    pub(crate) fn takes(self, format: MapFormat) -> bool {
        match self {
            DocumentFormat::MaterialX | DocumentFormat::Usda => true,
            // Readers of Apple take no OpenEXR, and the specification of USDZ no TGA.
            DocumentFormat::Usdz => matches!(format, MapFormat::Png { .. }),
        }
    }
}
