//! Memory that a texture set takes in an engine, in the formats that its use suggests.

use schemars::JsonSchema;
use serde::Serialize;

use crate::{EngineFormat, OutputRecord};

/// Memory of textures in an engine; docs/report.md lists the keys.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct EngineMemory {
    /// Bytes of all textures with their mip levels.
    pub bytes: u64,
    /// Formats in use, each once.
    #[schemars(with = "Vec<String>")]
    pub formats: Vec<EngineFormat>,
    /// Bytes by texture set.
    pub sets: Vec<SetMemory>,
}

/// Memory of a texture set of one preset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
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
mod tests {
    use super::*;

    #[test]
    fn textures_are_summed_up_by_set() {
        let output = |material: &str, udim, engine_format: EngineFormat| OutputRecord {
            path: String::new(),
            preset: "raw".into(),
            channel: String::new(),
            components: Vec::new(),
            material: material.into(),
            width: 64,
            height: 64,
            bits: 8,
            color_space: "linear",
            udim,
            range: None,
            scale: None,
            engine_format,
            engine_bytes: engine_format.bytes([64, 64]),
            blake3: String::new(),
        };
        let outputs = [
            output("wood", Some(1001), EngineFormat::Bc4),
            output("wood", Some(1001), EngineFormat::Bc7),
            output("wood", Some(1002), EngineFormat::Bc4),
        ];
        let memory = EngineMemory::of(&outputs);
        // 341 blocks from 64 to 4 pixels, and two more.
        let (bc4, bc7) = (8 * 343, 16 * 343);
        let sets: Vec<(Option<u32>, u64)> = memory.sets.iter().map(|set| (set.udim, set.bytes)).collect();
        assert_eq!(sets, [(Some(1001), bc4 + bc7), (Some(1002), bc4)]);
        assert_eq!(memory.bytes, 2 * bc4 + bc7);
        assert_eq!(memory.formats, [EngineFormat::Bc7, EngineFormat::Bc4]);
        let large = EngineMemory {
            bytes: 12_900_000,
            ..memory
        };
        assert_eq!(
            large.sentence().as_deref(),
            Some("12.3 MiB in an engine: BC7 and BC4, with mips")
        );
        assert_eq!(EngineMemory::of(&[]).sentence(), None);
    }
}
