//! Formats of textures in an engine.

use serde::{Serialize, Serializer};

use crate::Channel;
use crate::preset::{Component, ComponentSource, Map, MapContent, MapFormat, components_of};

/// Format of a texture on a device, as engines import a file of its use.
///
/// Block compression has blocks of 4 × 4 pixels. Source: Khronos Data Format Specification 1.3, chapters "S3TC", "RGTC" and
/// "BPTC Compressed Texture Image Formats".
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EngineFormat {
    /// Colors and packed maps: three or four components of 8 bits.
    Bc7,
    /// Two components of 8 bits, and normals, whose third one is computed.
    Bc5,
    /// One component of 8 bits.
    Bc4,
    /// Colors of floats.
    Bc6h,
    /// Heights of 16 bits, whose steps would show after compression.
    R16,
    /// One component of floats.
    R16Float,
    /// Two components of floats.
    Rg16Float,
    /// Vectors of 16 bits, and other data with three or four components.
    Rgba16,
    /// Vectors of floats.
    Rgba16Float,
}

impl EngineFormat {
    /// Returns the format for a file with these components.
    pub(crate) fn of(components: &[Component], format: MapFormat) -> EngineFormat {
        let channels = || {
            components.iter().filter_map(|component| match &component.source {
                ComponentSource::Channel(channel, _) => Some(channel),
                ComponentSource::Output(..) | ComponentSource::Constant(_) => None,
            })
        };
        let is_normal = channels().count() == components.len() && channels().all(|channel| channel.is_tangent_normal());
        let is_color = channels().next().is_some_and(|channel| channel.is_color());
        let is_height = channels().any(|channel| channel.is_height());
        let is_deep = format.bits() > 8;
        match (components.len(), format.is_whole()) {
            (2.., _) if is_normal => EngineFormat::Bc5,
            (0 | 1, true) if is_height && is_deep => EngineFormat::R16,
            (0 | 1, true) => EngineFormat::Bc4,
            (0 | 1, false) => EngineFormat::R16Float,
            (2, true) => EngineFormat::Bc5,
            (2, false) => EngineFormat::Rg16Float,
            (_, true) if is_deep && !is_color => EngineFormat::Rgba16,
            (_, true) => EngineFormat::Bc7,
            (3, false) if is_color => EngineFormat::Bc6h,
            (_, false) => EngineFormat::Rgba16Float,
        }
    }

    /// Returns the format for a map of a preset.
    pub fn of_map(map: &Map) -> EngineFormat {
        match &map.content {
            MapContent::Packed(components) => EngineFormat::of(components, map.format),
            MapContent::Every(kind) => {
                EngineFormat::of(&components_of(&Channel::output(*kind, String::new())), map.format)
            }
        }
    }

    /// Name, as graphics interfaces have it.
    pub fn name(self) -> &'static str {
        match self {
            EngineFormat::Bc7 => "BC7",
            EngineFormat::Bc5 => "BC5",
            EngineFormat::Bc4 => "BC4",
            EngineFormat::Bc6h => "BC6H",
            EngineFormat::R16 => "R16",
            EngineFormat::R16Float => "R16F",
            EngineFormat::Rg16Float => "RG16F",
            EngineFormat::Rgba16 => "RGBA16",
            EngineFormat::Rgba16Float => "RGBA16F",
        }
    }

    /// Returns the bytes of a texture with all mip levels: each has half the sides of the one before, rounded down, until
    /// both are 1.
    pub fn bytes(self, size: [u32; 2]) -> u64 {
        let (side, block) = match self {
            EngineFormat::Bc4 => (4, 8),
            EngineFormat::Bc5 | EngineFormat::Bc6h | EngineFormat::Bc7 => (4, 16),
            EngineFormat::R16 | EngineFormat::R16Float => (1, 2),
            EngineFormat::Rg16Float => (1, 4),
            EngineFormat::Rgba16 | EngineFormat::Rgba16Float => (1, 8),
        };
        let levels = 32 - size[0].max(size[1]).max(1).leading_zeros();
        let level = |level: u32| {
            let blocks = size.map(|pixels| u64::from((pixels >> level).max(1)).div_ceil(side));
            blocks[0] * blocks[1] * block
        };
        (0..levels).map(level).sum()
    }
}

impl Serialize for EngineFormat {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::builtin;

    #[test]
    fn the_bytes_of_a_texture_are_those_of_its_blocks_in_all_levels() {
        let cases = [
            // (4^11 - 1) / 3 blocks from 4096 to 4 pixels, and one for each of 2 and 1.
            (EngineFormat::Bc7, [4096, 4096], 16 * ((4_u64.pow(11) - 1) / 3 + 2)),
            (EngineFormat::Bc7, [4096, 4096], 22_369_648),
            (EngineFormat::Bc5, [2048, 2048], 16 * ((4_u64.pow(10) - 1) / 3 + 2)),
            (EngineFormat::Bc4, [2048, 2048], 8 * ((4_u64.pow(10) - 1) / 3 + 2)),
            (EngineFormat::Bc6h, [4, 4], 16 * 3),
            (EngineFormat::Bc4, [1, 1], 8),
            // 10 × 6 pixels are 3 × 2 blocks, 5 × 3 are 2 × 1, 2 × 1 and 1 × 1 are one each.
            (EngineFormat::Bc4, [10, 6], 8 * (6 + 2 + 1 + 1)),
            // A quarter of the pixels in each level.
            (EngineFormat::R16, [1024, 1024], 2 * (4_u64.pow(11) - 1) / 3),
            (EngineFormat::Rgba16Float, [2, 2], 8 * 5),
            (EngineFormat::Rg16Float, [8, 1], 4 * (8 + 4 + 2 + 1)),
            (EngineFormat::Bc7, [0, 0], 16),
        ];
        for (format, size, bytes) in cases {
            assert_eq!(format.bytes(size), bytes, "{format:?} {size:?}");
        }
    }

    /// Formats of the maps of a preset, with their names.
    fn formats(preset: &str) -> Vec<(String, EngineFormat)> {
        let preset = builtin(preset).unwrap().unwrap();
        let of = |map: &Map| (map.name.clone(), EngineFormat::of_map(map));
        preset.maps.iter().map(of).collect()
    }

    #[test]
    fn the_format_follows_the_use_of_a_map() {
        let raw = formats("raw");
        let of = |name: &str| {
            let found = raw.iter().filter(|(known, _)| known == name);
            found.map(|(_, format)| *format).collect::<Vec<_>>()
        };
        assert_eq!(of("base_color"), [EngineFormat::Bc7]);
        assert_eq!(of("roughness"), [EngineFormat::Bc4]);
        assert_eq!(of("normal"), [EngineFormat::Bc5], "of 16 bits, too");
        assert_eq!(of("height"), [EngineFormat::R16Float, EngineFormat::R16]);
        assert_eq!(of("emission"), [EngineFormat::Bc7, EngineFormat::Bc6h]);
        assert_eq!(
            formats("unity")[..2],
            [
                ("BaseMap".to_owned(), EngineFormat::Bc7),
                ("MaskMap".to_owned(), EngineFormat::Bc7)
            ]
        );
    }
}
