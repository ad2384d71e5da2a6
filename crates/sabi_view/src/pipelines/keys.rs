//! Keys of pipelines: the purpose of each, and the properties for which it is specialized.

use super::switches::{RasterVariant, Switches};
use crate::shaders::ViewShader;

/// Key of a pipeline: its purpose and all properties for which it is specialized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PipelineKey {
    /// Rasterizes the model: finds the visible point for each pixel.
    Raster {
        is_double_sided: bool,
        variant: RasterVariant,
        switches: Switches,
    },
    /// Shades the pixels of the model.
    Shade(Shading, Switches),
    /// Draws the picture behind the model, with the shade on the ground.
    Background(BackgroundKey),
    Lines,
    /// Depth of the model as seen from a light. If a material has transparent places, its maps are used.
    Shadow(Option<Switches>),
    /// A step of the bloom, which spreads the light above white.
    Bloom(BloomStep),
    /// Adds a sample to the sum of the earlier samples.
    Accumulate(Development),
    /// Encodes the only sample.
    Encode(Development),
    /// Encodes the only sample, for the pixels that show the model.
    EncodeModel(Development),
    /// Encodes the mean of the samples.
    EncodeMean,
}

/// Step of the bloom, which spreads the light above white: an entry point of `bloom.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum BloomStep {
    /// Gathers the light above white.
    Gather,
    /// Halves a level.
    Halve,
    /// Mixes a level with the coarser ones.
    Mix,
}

impl BloomStep {
    pub(crate) const ALL: [BloomStep; 3] = [BloomStep::Gather, BloomStep::Halve, BloomStep::Mix];

    pub(super) fn entry(self) -> &'static str {
        match self {
            BloomStep::Gather => "gather_bright",
            BloomStep::Halve => "halve",
            BloomStep::Mix => "mix_levels",
        }
    }
}

/// Conversion of light to display colors: the overrides of `display.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Development {
    /// `TRANSFORM`.
    pub(crate) transform: Transform,
    /// `BLOOM`.
    pub(crate) has_bloom: bool,
}

/// View transform: `TRANSFORM` of `display.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Transform(pub(crate) u32);

impl Transform {
    pub(crate) const STANDARD: Transform = Transform(0);
    pub(crate) const AGX: Transform = Transform(1);
    pub(crate) const ACES: Transform = Transform(2);
    /// For pictures that are already encoded.
    pub(crate) const ENCODED: Transform = Transform(3);
    pub(crate) const NEUTRAL: Transform = Transform(4);
    pub(crate) const AGX_PUNCHY: Transform = Transform(5);
}

impl Development {
    /// For light that is already transformed.
    pub(super) const DONE: Development = Development {
        transform: Transform::STANDARD,
        has_bloom: false,
    };
}

/// Picture behind the model: the overrides of `background.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct BackgroundKey {
    /// `BACKDROP`.
    pub(crate) backdrop: Backdrop,
    /// `GROUND`.
    pub(crate) has_ground: bool,
    /// Lights that cast shadows on the ground.
    pub(crate) switches: Switches,
}

/// `BACKDROP` of `background.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Backdrop(pub(crate) u32);

impl Backdrop {
    pub(crate) const ENVIRONMENT: Backdrop = Backdrop(0);
    pub(crate) const BLURRED: Backdrop = Backdrop(1);
    pub(crate) const STUDIO: Backdrop = Backdrop(2);
    /// Only the shade on the ground.
    pub(crate) const NOTHING: Backdrop = Backdrop(3);
}

/// Shading of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Shading {
    Lit,
    /// Lit, with shadows of the heights.
    LitRelief,
    /// A mode other than the lit material.
    Unlit,
}

impl PipelineKey {
    /// Module with the entry points.
    pub(super) fn shader(self) -> ViewShader {
        match self {
            PipelineKey::Raster { .. } => ViewShader::Raster,
            PipelineKey::Shade(..) => ViewShader::Paint,
            PipelineKey::Background(_) => ViewShader::Background,
            PipelineKey::Lines => ViewShader::Lines,
            PipelineKey::Shadow(_) => ViewShader::CastShadow,
            PipelineKey::Bloom(_) => ViewShader::Bloom,
            PipelineKey::Accumulate(_)
            | PipelineKey::Encode(_)
            | PipelineKey::EncodeModel(_)
            | PipelineKey::EncodeMean => ViewShader::Display,
        }
    }
}
