//! Memory that a texture set takes in an engine, in the formats that its use suggests.

use serde::{Serialize, Serializer};

use crate::OutputRecord;
use crate::preset::{Component, ComponentSource, Format};

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
    /// Vectors of 16 bits, and other things of three or four.
    Rgba16,
    /// Vectors of floats.
    Rgba16Float,
}

impl EngineFormat {
    /// Returns the format for a file with these components.
    pub(crate) fn of(components: &[Component], format: Format) -> EngineFormat {
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

/// Memory of textures in an engine; docs/report.md lists the keys.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct EngineMemory {
    /// Bytes of all textures with their mip levels.
    pub bytes: u64,
    /// Formats in use, each once.
    pub formats: Vec<EngineFormat>,
    /// Bytes by texture set.
    pub sets: Vec<SetMemory>,
}

/// Memory of a texture set of one preset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SetMemory {
    /// Preset that the files are of.
    pub preset: String,
    /// Stem of the set's files: the material.
    pub material: String,
    /// UDIM number, when the material uses several tiles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub udim: Option<u32>,
    /// Bytes of its textures with their mip levels.
    pub bytes: u64,
}

impl EngineMemory {
    /// Sums the textures of files up.
    pub fn of(outputs: &[OutputRecord]) -> EngineMemory {
        let mut memory = EngineMemory::default();
        for output in outputs {
            memory.bytes += output.engine_bytes;
            memory.formats.push(output.engine_format);
            let is_its = |set: &&mut SetMemory| {
                set.preset == output.preset && set.material == output.material && set.udim == output.udim
            };
            match memory.sets.iter_mut().find(is_its) {
                Some(set) => set.bytes += output.engine_bytes,
                None => memory.sets.push(SetMemory {
                    preset: output.preset.clone(),
                    material: output.material.clone(),
                    udim: output.udim,
                    bytes: output.engine_bytes,
                }),
            }
        }
        memory.formats.sort_unstable();
        memory.formats.dedup();
        memory
    }

    /// Returns the memory in a line: `12.3 MiB in an engine: BC7, BC5 and BC4, with mips`; none without textures.
    pub fn sentence(&self) -> Option<String> {
        let names: Vec<&str> = self.formats.iter().map(|format| format.name()).collect();
        let names = match &names[..] {
            [] => return None,
            [one] => (*one).to_owned(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
        };
        let mib = self.bytes as f64 / f64::from(1 << 20);
        Some(format!("{mib:.1} MiB in an engine: {names}, with mips"))
    }
}

#[cfg(test)]
mod tests;
