//! Records of written files and constants, for the report file.

use serde_json::{Value as Json, json};

use sabi_image::srgb8_from_linear;

use crate::{Channel, Value};

/// A file of a texture set.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputRecord {
    /// The file, relative to the output folder.
    pub path: String,
    /// Channel of the file.
    pub channel: Channel,
    /// Stem of the set's files: the material.
    pub material: String,
    /// UDIM number, when the material uses several tiles.
    pub udim: Option<u32>,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Bits of a sample: 8 or 16 whole, 32 floating.
    pub bits: u8,
    /// `srgb` or `linear`.
    pub color_space: &'static str,
    /// Values of the lowest and highest code, in model units; only for heights as integers.
    pub range: Option<[f32; 2]>,
    /// BLAKE3 of the file's bytes, hexadecimal.
    pub blake3: String,
}

/// A channel that has no file because it is the same everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantRecord {
    /// Channel that is constant.
    pub channel: Channel,
    /// Stem of the set's files: the material.
    pub material: String,
    /// UDIM number, when the material uses several tiles.
    pub udim: Option<u32>,
    /// Its value, linear.
    pub value: Value,
}

/// A number as short as an f32 can be written, as a reader of the report expects it.
pub(crate) fn short(value: f32) -> Json {
    value
        .to_string()
        .parse::<f64>()
        .map_or(Json::Null, |exact| json!(exact))
}

impl OutputRecord {
    /// An entry of the report's `outputs`.
    pub fn to_json(&self) -> Json {
        let mut entry = json!({
            "path": self.path,
            "channel": self.channel.name(),
            "material": self.material,
            "width": self.width,
            "height": self.height,
            "bits": self.bits,
            "color_space": self.color_space,
        });
        if let Some(udim) = self.udim {
            entry["udim"] = json!(udim);
        }
        if let Some(range) = self.range {
            entry["range"] = Json::Array(range.map(short).to_vec());
        }
        entry["blake3"] = json!(self.blake3);
        entry
    }
}

impl ConstantRecord {
    /// An entry of the report's `constants`. Colors come linear and, where they fit, as the hexadecimal sRGB that artists
    /// write.
    pub fn to_json(&self) -> Json {
        let mut entry = json!({ "channel": self.channel.name(), "material": self.material });
        if let Some(udim) = self.udim {
            entry["udim"] = json!(udim);
        }
        match self.value {
            Value::Number(value) => entry["value"] = short(value),
            Value::Triple(values) => {
                entry["value"] = Json::Array(values.map(short).to_vec());
                let is_color = matches!(self.channel, Channel::BaseColor | Channel::Emission);
                if is_color && values.iter().all(|value| (0.0..=1.0).contains(value)) {
                    let [r, g, b] = values.map(srgb8_from_linear);
                    entry["srgb"] = json!(format!("#{r:02x}{g:02x}{b:02x}"));
                }
            }
        }
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_read_as_the_report_promises() {
        let output = OutputRecord {
            path: "wood_height.png".into(),
            channel: Channel::Height,
            material: "wood".into(),
            udim: None,
            width: 64,
            height: 64,
            bits: 16,
            color_space: "linear",
            range: Some([-0.1, 0.7]),
            blake3: "ab".into(),
        };
        assert_eq!(
            output.to_json().to_string(),
            r#"{"path":"wood_height.png","channel":"height","material":"wood","width":64,"height":64,"bits":16,"color_space":"linear","range":[-0.1,0.7],"blake3":"ab"}"#
        );
        let constant = |channel, value| {
            ConstantRecord {
                channel,
                material: "wood".into(),
                udim: Some(1002),
                value,
            }
            .to_json()
            .to_string()
        };
        assert_eq!(
            constant(Channel::Roughness, Value::Number(0.7)),
            r#"{"channel":"roughness","material":"wood","udim":1002,"value":0.7}"#
        );
        assert_eq!(
            constant(Channel::BaseColor, Value::Triple([1.0, 0.5, 0.0])),
            r##"{"channel":"base_color","material":"wood","udim":1002,"value":[1.0,0.5,0.0],"srgb":"#ffbc00"}"##
        );
        assert!(!constant(Channel::Normal, Value::Triple([0.0, 0.0, 1.0])).contains("srgb"));
    }
}
