//! The channels of a texture set.

use std::borrow::Cow;

use rayon::prelude::*;
use sabi_image::DitherPattern;
use serde::{Serialize, Serializer};

use crate::MeshMap;

/// A channel of a texture set.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Linear RGB.
    BaseColor,
    /// 0 clear, 1 opaque.
    Opacity,
    /// 0 mirror, 1 fully rough.
    Roughness,
    /// 0 or 1.
    Metallic,
    /// 1 open, 0 fully occluded.
    Occlusion,
    /// Height in the model's own units.
    Height,
    /// Tangent-space unit vector, Y+, components in −1..1.
    Normal,
    /// Linear RGB, may exceed 1.
    Emission,
    /// Strength of a clear coat, 0..1.
    Coat,
    /// Roughness of the clear coat: 0 mirror, 1 fully rough.
    CoatRoughness,
    /// As in KHR_materials_anisotropy: the tangent-space unit direction along which highlights are stretched, −1..1 stored
    /// as 0..1 in R and G, and the strength in B.
    Anisotropy,
    /// Color of a sheen, linear RGB, 0..1.
    Sheen,
    /// Roughness of the sheen.
    SheenRoughness,
    /// Shares of the light that spread below the surface, linear RGB, 0..1.
    Subsurface,
    /// Share of the light that passes through, 0..1.
    Transmission,
    /// A mask output of the graph, by its name.
    Mask(String),
    /// A color output of the graph, by its name: linear RGB, may exceed 1.
    Color(String),
    /// A vector output of the graph, by its name: any numbers.
    Vector(String),
    /// A map of the model itself.
    Mesh(MeshMap),
}

/// Kind of an output of the graph other than materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutputKind {
    /// One number.
    Mask,
    /// Linear RGB.
    Color,
    /// Three numbers.
    Vector,
}

impl OutputKind {
    /// All kinds.
    pub const ALL: [OutputKind; 3] = [OutputKind::Mask, OutputKind::Color, OutputKind::Vector];

    /// Returns the word in preset files for all outputs of the kind.
    pub fn plural(self) -> &'static str {
        match self {
            OutputKind::Mask => "masks",
            OutputKind::Color => "colors",
            OutputKind::Vector => "vectors",
        }
    }
}

/// Names that an output cannot have, because files of channels have them.
const TAKEN: [&str; 15] = [
    "base_color",
    "opacity",
    "roughness",
    "metallic",
    "occlusion",
    "height",
    "normal",
    "emission",
    "coat",
    "coat_roughness",
    "anisotropy",
    "sheen",
    "sheen_roughness",
    "subsurface",
    "transmission",
];

impl Serialize for Channel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

impl Channel {
    /// All channels of materials, in the order in which they are written.
    pub const ALL: [Channel; 15] = [
        Channel::BaseColor,
        Channel::Opacity,
        Channel::Roughness,
        Channel::Metallic,
        Channel::Occlusion,
        Channel::Height,
        Channel::Normal,
        Channel::Emission,
        Channel::Coat,
        Channel::CoatRoughness,
        Channel::Anisotropy,
        Channel::Sheen,
        Channel::SheenRoughness,
        Channel::Subsurface,
        Channel::Transmission,
    ];

    /// Returns true for channels that few materials have. Texture sets without them do not mention them.
    pub fn is_rare(&self) -> bool {
        matches!(
            self,
            Channel::Coat
                | Channel::CoatRoughness
                | Channel::Anisotropy
                | Channel::Sheen
                | Channel::SheenRoughness
                | Channel::Subsurface
                | Channel::Transmission
        )
    }

    /// True for colors, which artists write in sRGB.
    pub(crate) fn is_color(&self) -> bool {
        matches!(
            self,
            Channel::BaseColor | Channel::Emission | Channel::Sheen | Channel::Subsurface | Channel::Color(_)
        ) || matches!(self, Channel::Mesh(map) if map.is_color())
    }

    /// Creates the channel of an output of the graph.
    pub fn output(kind: OutputKind, name: String) -> Channel {
        match kind {
            OutputKind::Mask => Channel::Mask(name),
            OutputKind::Color => Channel::Color(name),
            OutputKind::Vector => Channel::Vector(name),
        }
    }

    /// Returns the kind of output; `None` for channels of materials and maps of the model.
    pub fn output_kind(&self) -> Option<OutputKind> {
        match self {
            Channel::Mask(_) => Some(OutputKind::Mask),
            Channel::Color(_) => Some(OutputKind::Color),
            Channel::Vector(_) => Some(OutputKind::Vector),
            _ => None,
        }
    }

    /// Returns the name of the output; `None` for other channels.
    pub fn output_name(&self) -> Option<&str> {
        match self {
            Channel::Mask(name) | Channel::Color(name) | Channel::Vector(name) => Some(name),
            _ => None,
        }
    }

    /// Returns true for tangent-space normals, whose third component follows from the other two.
    pub(crate) fn is_tangent_normal(&self) -> bool {
        *self == Channel::Normal
    }

    /// Returns true for heights, in which quantization steps are visible.
    pub(crate) fn is_height(&self) -> bool {
        *self == Channel::Height
    }

    /// Returns the name in reports and in file names, such as `base_color`. For an output it is the output's name, made
    /// valid as a file name and different from the names of channels.
    pub fn name(&self) -> Cow<'_, str> {
        match self {
            Channel::BaseColor => "base_color".into(),
            Channel::Opacity => "opacity".into(),
            Channel::Roughness => "roughness".into(),
            Channel::Metallic => "metallic".into(),
            Channel::Occlusion => "occlusion".into(),
            Channel::Height => "height".into(),
            Channel::Normal => "normal".into(),
            Channel::Emission => "emission".into(),
            Channel::Coat => "coat".into(),
            Channel::CoatRoughness => "coat_roughness".into(),
            Channel::Anisotropy => "anisotropy".into(),
            Channel::Sheen => "sheen".into(),
            Channel::SheenRoughness => "sheen_roughness".into(),
            Channel::Subsurface => "subsurface".into(),
            Channel::Transmission => "transmission".into(),
            Channel::Mask(name) => output_name("mask", name).into(),
            Channel::Color(name) => output_name("color", name).into(),
            Channel::Vector(name) => output_name("vector", name).into(),
            Channel::Mesh(map) => map.name().into(),
        }
    }

    /// Returns the noise of a component. It is the same in each file in which the component is dithered.
    pub(crate) fn dither_pattern(&self, component: usize, seed: u32) -> DitherPattern {
        DitherPattern::new(seed, &self.name(), component)
    }

    /// Values of a pixel: 3 for colors and normals, else 1.
    pub fn components(&self) -> usize {
        match self {
            Channel::Normal | Channel::Anisotropy | Channel::Vector(_) => 3,
            Channel::Mesh(map) => map.neutral().len(),
            color if color.is_color() => 3,
            _ => 1,
        }
    }

    /// Returns the neutral value: not metallic, flat, not occluded, opaque, half rough, middle gray.
    pub fn neutral(&self) -> &'static [f32] {
        match self {
            // These are `PLAIN_MATERIAL` of `lib/core.wgsl`; a test compares them.
            Channel::BaseColor => &[0.214; 3],
            Channel::Opacity | Channel::Occlusion => &[1.0],
            Channel::Roughness => &[0.7],
            Channel::Metallic
            | Channel::Height
            | Channel::Coat
            | Channel::CoatRoughness
            | Channel::SheenRoughness
            | Channel::Transmission
            | Channel::Mask(_) => &[0.0],
            Channel::Normal => &[0.0, 0.0, 1.0],
            Channel::Emission | Channel::Sheen | Channel::Subsurface | Channel::Color(_) | Channel::Vector(_) => {
                &[0.0; 3]
            }
            Channel::Mesh(map) => map.neutral(),
            Channel::Anisotropy => &[1.0, 0.5, 0.0],
        }
    }
}

/// Name of the map of an output, whose kind has this word.
fn output_name(kind: &str, name: &str) -> String {
    let stem = crate::names::file_stem(name);
    if stem.is_empty() {
        kind.to_owned()
    } else if TAKEN.contains(&stem.to_lowercase().as_str()) {
        format!("{kind}_{stem}")
    } else {
        stem
    }
}

/// One channel of one texture set.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelPixels {
    /// Values of a pixel, as [`Channel::components`].
    pub components: usize,
    /// Linear values, row by row from the top, components interleaved.
    pub data: Vec<f32>,
}

/// Pixels that are filled in one parallel task.
const NEUTRAL_PIXELS: usize = 1 << 16;

impl ChannelPixels {
    /// Creates pixels of a channel's neutral value.
    pub fn neutral(channel: &Channel, pixels: usize) -> ChannelPixels {
        let neutral = channel.neutral();
        let components = neutral.len().max(1);
        let mut data = vec![0.0; pixels * components];
        // In parallel: the system provides memory as it is first written, which takes as long as the writing.
        data.par_chunks_mut(components * NEUTRAL_PIXELS).for_each(|part| {
            let pixels = part.chunks_exact_mut(components);
            pixels.for_each(|pixel| pixel.copy_from_slice(neutral));
        });
        ChannelPixels { components, data }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_never_takes_the_name_of_a_channel() {
        assert_eq!(Channel::Mask("wear".into()).name(), "wear");
        assert_eq!(Channel::Mask("Roughness".into()).name(), "mask_Roughness");
        assert_eq!(Channel::Mask("../up".into()).name(), "__up");
        assert_eq!(Channel::Mask(String::new()).name(), "mask");
        assert_eq!(Channel::Color("height".into()).name(), "color_height");
        assert_eq!(Channel::Vector("..".into()).name(), "vector");
        for channel in Channel::ALL {
            assert_eq!(channel.neutral().len(), channel.components());
            assert!(TAKEN.contains(&&*channel.name()));
        }
    }
}
