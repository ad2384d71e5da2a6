//! Shader modules of the viewport: the files that each is linked from.

use sabi_nodes::link::{Given, ModuleSpec};
use strum::VariantArray;

/// Bind group of the surface, which follows those of the viewport; see `lib/atlas.wgsl`.
const SURFACE_GROUP: Given = Given::group("SURFACE_GROUP", 3);

/// A module with the entry points of one kind of pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, VariantArray)]
pub(crate) enum ViewShader {
    Raster,
    Paint,
    Background,
    Lines,
    CastShadow,
    Bloom,
    Display,
    PanoramaToCube,
    HalveCube,
    Prefilter,
}

impl ViewShader {
    pub(crate) const ALL: &'static [ViewShader] = ViewShader::VARIANTS;

    /// Returns the file to link, and the values that it receives.
    pub(crate) fn spec(self) -> ModuleSpec {
        let surface = vec![SURFACE_GROUP];
        let (label, file, given) = match self {
            ViewShader::Raster => ("raster", "view/raster", surface),
            ViewShader::Paint => ("paint", "view/paint", surface),
            ViewShader::Background => ("background", "view/background", Vec::new()),
            ViewShader::Lines => ("lines", "view/lines", Vec::new()),
            ViewShader::CastShadow => ("shadow", "view/cast_shadow", Vec::new()),
            ViewShader::Bloom => ("bloom", "view/bloom", Vec::new()),
            ViewShader::Display => ("display", "view/display", Vec::new()),
            ViewShader::PanoramaToCube => ("panorama to cube", "view/panorama_to_cube", Vec::new()),
            ViewShader::HalveCube => ("halve cube", "view/halve_cube", Vec::new()),
            ViewShader::Prefilter => ("prefilter", "view/prefilter", Vec::new()),
        };
        ModuleSpec {
            label,
            files: vec![file],
            given,
        }
    }
}

/// Returns everything from which modules of the viewport are linked, for tests.
pub fn view_modules() -> Vec<ModuleSpec> {
    ViewShader::ALL.iter().map(|shader| shader.spec()).collect()
}
