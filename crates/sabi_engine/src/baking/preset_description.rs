//! Descriptions of presets, for `sabi presets` and the window.

use sabi_export::preset::{DocumentFormat, Map, MapContent, MapFormat, MapSize, NormalY, Preset, When};
use sabi_export::{Channel, EngineFormat};
use schemars::JsonSchema;
use serde::Serialize;

/// Description of a preset; docs/report.md lists the keys.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PresetDescription {
    /// Name in the file.
    pub name: String,
    /// Description, a sentence.
    pub about: String,
    /// `+` if green of normal maps means upward, `-` if it means downward.
    pub normal_y: &'static str,
    /// Pattern of file names.
    pub names: String,
    /// Its files.
    pub files: Vec<PresetFileDescription>,
    /// Its documents.
    pub documents: Vec<PresetDocument>,
    /// Channels of materials that none of its files contains, so that a bake leaves them out.
    pub left_out: Vec<String>,
}

/// Description of a document of a preset. Its name is that of the model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct PresetDocument {
    /// Format, as preset files name it.
    pub format: &'static str,
    /// Ending of the file.
    pub ending: &'static str,
    /// Its content, in a line.
    pub about: &'static str,
}

/// A file of a preset in words.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PresetFileDescription {
    /// Word in the name of the file; `None` for the files of outputs, which have the names of the outputs.
    pub map: Option<String>,
    /// `masks`, `colors` or `vectors` for a file for each output of that kind.
    pub outputs: Option<&'static str>,
    /// Ending of the file.
    pub ending: &'static str,
    /// Bits of a sample.
    pub bits: u8,
    /// Content of each component in the order of the file; empty for the files of outputs.
    pub components: Vec<String>,
    /// `srgb` or `linear`.
    pub color_space: &'static str,
    /// True if gradients are dithered.
    pub dither: bool,
    /// True if the file stores 0 to 1 whatever the range of its channel is. The report of a bake says how to convert back.
    pub normalize: bool,
    /// Format in which an engine stores it.
    pub engine_format: &'static str,
    /// Size if it differs from that of the bake: `1/2` or `2048x1024`.
    pub size: Option<String>,
    /// Condition for writing it, in the form of preset files.
    pub when: String,
}

impl PresetFileDescription {
    /// Returns its content in a line: `R occlusion, G roughness, B metallic`.
    pub fn packing(&self) -> String {
        let letters: &[&str] = match self.components.len() {
            0 => return format!("each of the graph's {}", self.outputs.unwrap_or("outputs")),
            1 => return self.components[0].clone(),
            2 => &["gray", "A"],
            _ => &["R", "G", "B", "A"],
        };
        let parts = letters.iter().zip(&self.components);
        let parts: Vec<String> = parts
            .map(|(letter, component)| format!("{letter} {component}"))
            .collect();
        // A whole color is shown as one word, which is easier to read.
        let whole = self.components.first().and_then(|first| first.strip_suffix(".r"));
        let is_whole = |name: &&str| {
            let letters = ["r", "g", "b"].into_iter().map(|letter| format!("{name}.{letter}"));
            self.components.iter().take(3).cloned().eq(letters)
        };
        if let [r, g, b, more @ ..] = &self.components[..]
            && r == g
            && g == b
        {
            let alpha = more.iter().map(|alpha| format!(", A {alpha}"));
            return format!("RGB {r}{}", alpha.collect::<String>());
        }
        match whole.filter(is_whole) {
            Some(name) => [&[format!("RGB {name}")], &parts[3..]].concat().join(", "),
            None => parts.join(", "),
        }
    }
}

/// Describes a preset.
pub fn describe_preset(preset: &Preset) -> PresetDescription {
    PresetDescription {
        name: preset.name.clone(),
        about: preset.about.clone(),
        normal_y: match preset.normal_y {
            NormalY::Up => "+",
            NormalY::Down => "-",
        },
        names: preset.names.clone(),
        files: preset.maps.iter().map(file).collect(),
        documents: preset.documents.iter().map(document).collect(),
        left_out: match preset.left_out() {
            // A preset without maps of materials reports no channels as left out.
            all if all.len() == Channel::ALL.len() => Vec::new(),
            left_out => left_out.iter().map(|channel| channel.name().into_owned()).collect(),
        },
    }
}

fn document(document: &DocumentFormat) -> PresetDocument {
    PresetDocument {
        format: document.name(),
        ending: document.ending(),
        about: document.about(),
    }
}

fn file(map: &Map) -> PresetFileDescription {
    let (name, outputs, components) = match &map.content {
        MapContent::Every(kind) => (None, Some(kind.plural()), Vec::new()),
        MapContent::Packed(components) => {
            let components = components.iter().map(ToString::to_string).collect();
            (Some(map.name.clone()), None, components)
        }
    };
    PresetFileDescription {
        map: name,
        outputs,
        ending: MapFormat::ending(map.format),
        bits: map.format.bits(),
        components,
        color_space: if map.is_srgb { "srgb" } else { "linear" },
        dither: map.is_dithered,
        normalize: map.is_normalized,
        engine_format: EngineFormat::of_map(map).name(),
        size: match map.size {
            MapSize::Divided(1) => None,
            MapSize::Divided(by) => Some(format!("1/{by}")),
            MapSize::Fixed([width, height]) => Some(format!("{width}x{height}")),
        },
        when: match &map.when {
            When::Varies => "varies".to_owned(),
            When::Always => "always".to_owned(),
            When::Connected(channel) => format!("connected({})", channel.name()),
            When::ItselfAboveOne => "above_one".to_owned(),
            When::AboveOne(channel) => format!("above_one({})", channel.name()),
        },
    }
}

#[cfg(test)]
mod tests {
    use sabi_export::preset::builtin;

    use super::*;

    #[test]
    fn the_packing_of_a_file_is_a_line() {
        let packing = |preset: &str| {
            let preset = builtin(preset).expect("a preset").expect("that is read");
            let files = describe_preset(&preset).files;
            files
                .iter()
                .map(PresetFileDescription::packing)
                .collect::<Vec<String>>()
        };
        let unity = packing("unity");
        assert_eq!(unity[0], "RGB base_color, A opacity");
        assert_eq!(unity[1], "R metallic, G occlusion, B 0.5, A 1 - roughness");
        assert_eq!(unity[3], "height");
        assert_eq!(
            unity[8..],
            ["masks", "colors", "colors", "vectors"].map(|kind| format!("each of the graph's {kind}"))
        );
        assert_eq!(unity[5], "R coat, G 1 - coat_roughness, B 0");
        let mesh = packing("mesh");
        assert_eq!(
            (mesh[0].as_str(), mesh[7].as_str()),
            ("RGB mesh(id)", "mesh(curvature)")
        );
        assert_eq!(packing("unreal")[1], "R occlusion, G roughness, B metallic");
    }

    #[test]
    fn presets_take_all_channels_that_their_target_has_and_name_the_others() {
        let left_out = |preset: &str| {
            let preset = builtin(preset).expect("a preset").expect("that is read");
            describe_preset(&preset).left_out.join(" ")
        };
        let cases = [
            ("raw", ""),
            ("blender", ""),
            ("materialx", ""),
            ("gltf", "height"),
            ("unreal", "sheen_roughness transmission"),
            ("unity", "sheen sheen_roughness subsurface transmission"),
            ("godot", "sheen sheen_roughness transmission"),
            ("usd", "anisotropy sheen sheen_roughness subsurface transmission"),
            ("mesh", ""),
        ];
        for (preset, channels) in cases {
            assert_eq!(left_out(preset), channels, "{preset}");
        }
    }
}
