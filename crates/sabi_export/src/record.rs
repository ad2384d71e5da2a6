//! Files and constant channels of a texture set, as the report of a bake lists them; docs/report.md lists the keys.

use sabi_color::srgb8_from_linear;
use schemars::JsonSchema;
use serde::Serialize;

use crate::preset::DocumentFormat;
use crate::{Channel, ConstantValue, EngineFormat};

/// A file of a texture set.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputRecord {
    /// The file, relative to the output folder.
    pub path: String,
    /// Preset that it is a file of.
    pub preset: String,
    /// Channel in it, or the map's name where several are packed.
    pub channel: String,
    /// Content of each component.
    pub components: Vec<String>,
    /// Stem of the set's files: the material.
    pub material: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Bits of a sample: 8 or 16 whole, 32 floating.
    pub bits: u8,
    /// `srgb` or `linear`.
    pub color_space: &'static str,
    /// UDIM number, when the material uses several tiles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub udim: Option<u32>,
    /// Heights of the lowest and highest code, in the model's own units; heights in whole numbers, and normalized ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f32; 2]>,
    /// Divisor of its values: emission is the map times this; normalized emission above 1 only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f32>,
    /// Format that an engine has it in.
    #[schemars(with = "String")]
    pub engine_format: EngineFormat,
    /// Bytes of it there, with all mip levels.
    pub engine_bytes: u64,
    /// BLAKE3 of the file's bytes, hexadecimal.
    pub blake3: String,
}

/// A channel that has no file because it is the same everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ConstantRecord {
    /// The channel.
    #[schemars(with = "String")]
    pub channel: Channel,
    /// Stem of the set's files: the material.
    pub material: String,
    /// UDIM number, when the material uses several tiles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub udim: Option<u32>,
    /// Its value, linear.
    pub value: ConstantValue,
    /// A color as its sRGB code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub srgb: Option<String>,
}

impl ConstantRecord {
    /// A constant channel of a set. Colors get their sRGB code, which is what artists write.
    pub(crate) fn new(channel: Channel, material: String, udim: Option<u32>, value: ConstantValue) -> ConstantRecord {
        let srgb = match value {
            ConstantValue::Triple(values) if channel.is_color() => {
                let is_color = values.iter().all(|value| (0.0..=1.0).contains(value));
                let [r, g, b] = values.map(srgb8_from_linear);
                is_color.then(|| format!("#{r:02x}{g:02x}{b:02x}"))
            }
            _ => None,
        };
        ConstantRecord {
            channel,
            material,
            udim,
            value,
            srgb,
        }
    }
}

/// Channels of a material that a preset has no map for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct UnmappedChannels {
    /// The preset.
    pub preset: String,
    /// Stem of the set's files: the material.
    pub material: String,
    /// Channels that the material has.
    #[schemars(with = "Vec<String>")]
    pub channels: Vec<Channel>,
}

/// A map in whole numbers that holds less than its channel, whose values exceed 1.
#[derive(Clone, Debug, PartialEq)]
pub struct CutMap {
    /// The file, relative to the output folder.
    pub path: String,
    /// Preset that it is a file of.
    pub preset: String,
    /// The channel.
    pub channel: Channel,
    /// Stem of the set's files: the material.
    pub material: String,
    /// Highest value of the channel.
    pub peak: f32,
}

/// A document of materials beside the maps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct DocumentRecord {
    /// The file, relative to the output folder.
    pub path: String,
    /// Preset that it belongs to.
    pub preset: String,
    /// Its format.
    pub format: DocumentFormat,
    /// Its materials.
    pub materials: Vec<DocumentedMaterial>,
    /// BLAKE3 of the file's bytes, hexadecimal.
    pub blake3: String,
}

/// A material of a document.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct DocumentedMaterial {
    /// Stem of the set's files: the material.
    pub material: String,
    /// Its names in the document.
    pub names: Vec<String>,
    /// Channels of the material that are not in the document.
    #[schemars(with = "Vec<String>")]
    pub left_out: Vec<Channel>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_read_as_the_report_promises() {
        let output = OutputRecord {
            path: "wood_height.png".into(),
            preset: "raw".into(),
            channel: "height".into(),
            components: vec!["height".into()],
            material: "wood".into(),
            width: 64,
            height: 64,
            bits: 16,
            color_space: "linear",
            udim: None,
            range: Some([-0.1, 0.7]),
            scale: None,
            engine_format: EngineFormat::R16,
            engine_bytes: 10_922,
            blake3: "ab".into(),
        };
        assert_eq!(
            serde_json::to_string(&output).unwrap(),
            r#"{"path":"wood_height.png","preset":"raw","channel":"height","components":["height"],"material":"wood","width":64,"height":64,"bits":16,"color_space":"linear","range":[-0.1,0.7],"engine_format":"R16","engine_bytes":10922,"blake3":"ab"}"#
        );
        let constant = |channel, value| {
            let record = ConstantRecord::new(channel, "wood".into(), Some(1002), value);
            serde_json::to_string(&record).unwrap()
        };
        assert_eq!(
            constant(Channel::Roughness, ConstantValue::Number(0.7)),
            r#"{"channel":"roughness","material":"wood","udim":1002,"value":0.7}"#
        );
        assert_eq!(
            constant(Channel::BaseColor, ConstantValue::Triple([1.0, 0.5, 0.0])),
            r##"{"channel":"base_color","material":"wood","udim":1002,"value":[1.0,0.5,0.0],"srgb":"#ffbc00"}"##
        );
        assert!(!constant(Channel::Normal, ConstantValue::Triple([0.0, 0.0, 1.0])).contains("srgb"));
    }
}
