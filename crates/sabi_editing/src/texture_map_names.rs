//! Sets and channels that the names of texture files stand for: names that the export presets write, and conventions of
//! ambientCG, Poly Haven, cgbookcase and other tools.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use sabi_engine::baking::preset_pictures::{PictureChannel, PresetPicture, preset_pictures};

/// Material channel that is read from an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ChannelReading {
    /// Input of *Combine material*.
    pub(crate) channel: String,
    /// Output of the image node; `None` means the first one.
    pub(crate) output: Option<&'static str>,
    /// True if the image holds 1 minus the value.
    pub(crate) is_inverted: bool,
    /// True for normal maps whose green channel points down, as in DirectX.
    pub(crate) is_green_down: bool,
    /// True if the channel is read only if the image has alpha, since other presets use the same name for an image without alpha.
    pub(crate) needs_alpha: bool,
}

/// Set and map that a file name stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MapName {
    /// Name of the set in lower case.
    pub(crate) set: String,
    /// Channels in the image; empty for a map that is not part of a material, such as a position map.
    pub(crate) readings: Vec<ChannelReading>,
    /// Number of the UDIM tile, if the name has one.
    pub(crate) tile: Option<u32>,
}

const COLOR: Option<&str> = None;
const GRAY: Option<&str> = Some("mask");
const RED: Option<&str> = Some("r");
const GREEN: Option<&str> = Some("g");
const BLUE: Option<&str> = Some("b");
const ALPHA: Option<&str> = Some("alpha");
/// Input of *Combine material* for the opacity.
const OPACITY: &str = "alpha";

/// Words with which other tools name an image, in lower case and without spaces, and the channels in the image with the
/// outputs of the image node.
type Convention = (&'static [&'static str], &'static [(&'static str, Option<&'static str>)]);
const CONVENTIONS: [Convention; 12] = [
    (
        &["color", "col", "basecolor", "albedo", "diff", "diffuse", "base"],
        &[("base_color", COLOR)],
    ),
    (&["roughness", "rough", "rgh"], &[("roughness", GRAY)]),
    (&["metallic", "metalness", "metal", "mtl"], &[("metallic", GRAY)]),
    (&["ambientocclusion", "occlusion", "ao"], &[("occlusion", GRAY)]),
    (
        &["displacement", "displace", "disp", "height", "bump"],
        &[("height", GRAY)],
    ),
    (
        &["normal", "normals", "normalmap", "nor", "norm", "nrm"],
        &[("slope", Some("slope"))],
    ),
    (&["opacity", "alpha", "transparency"], &[("alpha", GRAY)]),
    (&["emission", "emissive", "emit"], &[("emission", COLOR)]),
    (
        &["arm", "orm"],
        &[("occlusion", RED), ("roughness", GREEN), ("metallic", BLUE)],
    ),
    (&["ord"], &[("occlusion", RED), ("roughness", GREEN), ("height", BLUE)]),
    (
        &["rma"],
        &[("roughness", RED), ("metallic", GREEN), ("occlusion", BLUE)],
    ),
    (
        &["mra"],
        &[("metallic", RED), ("roughness", GREEN), ("occlusion", BLUE)],
    ),
];

/// Words for normal maps whose green points up.
const UP: [&str; 3] = ["gl", "opengl", "ogl"];
/// Words for normal maps whose green points down.
const DOWN: [&str; 3] = ["dx", "directx", "d3d"];
/// Words for the format of a file.
const STORED: [&str; 6] = ["jpg", "jpeg", "png", "exr", "tif", "tiff"];
/// Maximum number of words of a file name that form the name of its map.
const MOST_WORDS: usize = 3;
/// Numbers of UDIM tiles.
const TILES: std::ops::RangeInclusive<u32> = 1001..=1999;

impl MapName {
    /// Parses the name of a file; none if it does not name a map.
    pub(crate) fn of(file: &Path) -> Option<MapName> {
        let stem = file.file_stem()?.to_string_lossy().to_lowercase();
        let (stem, tile) = split_tile(&stem);
        let mut words: Vec<&str> = stem
            .split(|letter: char| !letter.is_alphanumeric())
            .filter(|word| !word.is_empty() && !is_stored(word))
            .collect();
        let known = KnownNames::get();
        // A prefix comes before the name of a material.
        let has_prefix = words.len() > 2 && known.prefixes.iter().any(|prefix| prefix == words[0]);
        let prefix = if has_prefix { words.remove(0) } else { "" };
        let direction = take_direction(&mut words, known);
        let most = words.len().min(MOST_WORDS);
        let found = (1..=most).rev().find_map(|count| {
            let (set, map) = words.split_at(words.len() - count);
            Some((set, known.readings(&map.concat(), prefix)?))
        });
        let (set, mut readings) = found?;
        if let Some(is_down) = direction {
            // Only normal maps have a direction of green.
            let [reading] = &mut readings[..] else { return None };
            if reading.channel != "slope" {
                return None;
            }
            reading.is_green_down = is_down;
        }
        let set = set.join("_");
        Some(MapName { set, readings, tile })
    }
}

/// Images by the words that name them.
struct KnownNames {
    /// Images of presets by name, in lower case and without spaces, with the words before the name of the material.
    of_presets: BTreeMap<String, Vec<(String, Vec<ChannelReading>)>>,
    /// Words before the name of the material.
    prefixes: Vec<String>,
}

impl KnownNames {
    fn get() -> &'static KnownNames {
        static KNOWN: OnceLock<KnownNames> = OnceLock::new();
        KNOWN.get_or_init(|| {
            let mut known = KnownNames {
                of_presets: BTreeMap::new(),
                prefixes: Vec::new(),
            };
            for picture in preset_pictures() {
                let prefix = plain(&picture.before);
                if !prefix.is_empty() && !known.prefixes.contains(&prefix) {
                    known.prefixes.push(prefix.clone());
                }
                let readings = picture.parts.iter().filter_map(|part| reading(&picture, part));
                let readings = readings.collect();
                let same_name = known.of_presets.entry(plain(&picture.name)).or_default();
                same_name.push((prefix, readings));
            }
            known
        })
    }

    /// Returns the channels of the image that a word stands for in a file name with a prefix. Channels of several presets
    /// with the same name are combined, such as the opacity that some of them store beside the base color.
    fn readings(&self, word: &str, prefix: &str) -> Option<Vec<ChannelReading>> {
        let of_presets = self.of_presets.get(word).map_or(&[][..], Vec::as_slice);
        // A single letter is ambiguous without the prefix that its preset writes.
        let is_clear = |(own, _): &&(String, Vec<ChannelReading>)| own == prefix || word.chars().count() > 1;
        let (own, others): (Vec<_>, Vec<_>) = of_presets
            .iter()
            .filter(is_clear)
            .partition(|(own, _)| !own.is_empty() && own == prefix);
        let convention = CONVENTIONS.iter().find(|(words, _)| words.contains(&word));
        if own.is_empty() && others.is_empty() && convention.is_none() {
            return None;
        }
        let convention = convention.into_iter().flat_map(|(_, channels)| *channels);
        let conventional = convention.map(|(channel, output)| ChannelReading {
            channel: (*channel).to_owned(),
            output: *output,
            is_inverted: false,
            is_green_down: false,
            needs_alpha: false,
        });
        let in_alpha = |(_, readings): &(String, Vec<ChannelReading>), channel: &str| {
            let mut readings = readings.iter();
            readings.any(|reading| reading.channel == channel && reading.output == ALPHA)
        };
        // An image without alpha is opaque, and so is a material without opacity. For other channels a missing alpha would
        // give a wrong value.
        let needs_alpha = |reading: &ChannelReading| {
            let is_certain = of_presets.iter().all(|preset| in_alpha(preset, &reading.channel));
            reading.output == ALPHA && reading.channel != OPACITY && !is_certain
        };
        let own = own.into_iter().flat_map(|(_, readings)| readings.clone());
        let others = others.into_iter().flat_map(|(_, readings)| readings.clone());
        let mut all: Vec<ChannelReading> = Vec::new();
        for mut reading in own.chain(conventional).chain(others) {
            reading.needs_alpha = needs_alpha(&reading);
            let is_taken = |known: &ChannelReading| known.channel == reading.channel || known.output == reading.output;
            if !all.iter().any(is_taken) {
                all.push(reading);
            }
        }
        Some(all)
    }
}

/// Returns how a part of a preset's image is read; `None` if *Combine material* has no such channel.
fn reading(picture: &PresetPicture, part: &PictureChannel) -> Option<ChannelReading> {
    let channel = match part.channel.as_deref()? {
        "opacity" => OPACITY,
        "normal" => "slope",
        // Anisotropy is a direction in the tangent frame, which an image node can only read for normals.
        "anisotropy" => return None,
        channel => channel,
    };
    let output = match (part.components.start, part.components.len()) {
        (0, 3) if channel == "slope" => Some("slope"),
        (0, 3) => COLOR,
        (_, 1) if part.is_alpha => ALPHA,
        (0, 1) if picture.is_gray => GRAY,
        (0, 1) => RED,
        (1, 1) => GREEN,
        (2, 1) => BLUE,
        _ => return None,
    };
    Some(ChannelReading {
        channel: channel.to_owned(),
        output,
        is_inverted: part.is_inverted,
        is_green_down: part.is_green_down,
        needs_alpha: false,
    })
}

/// Letters and digits of a text, in lower case.
fn plain(text: &str) -> String {
    let letters = text.chars().filter(|letter| letter.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

/// Removes the direction of green from the words if the last one contains it, alone or as in `normalgl`. Returns whether
/// green points down.
fn take_direction(words: &mut Vec<&str>, known: &KnownNames) -> Option<bool> {
    let last = *words.last()?;
    let is_named = |ends: &[&str]| ends.contains(&last);
    if is_named(&UP) || is_named(&DOWN) {
        words.pop();
        return Some(is_named(&DOWN));
    }
    let is_normal = |word: &str| {
        let readings = known.readings(word, "");
        readings.is_some_and(|readings| readings.iter().any(|reading| reading.channel == "slope"))
    };
    let cut = |ends: &[&str]| {
        let mut cut = ends.iter().filter_map(|end| last.strip_suffix(end));
        cut.find(|word| is_normal(word))
    };
    let (word, is_down) = match (cut(&UP), cut(&DOWN)) {
        (Some(word), _) => (word, false),
        (None, Some(word)) => (word, true),
        (None, None) => return None,
    };
    words.pop();
    words.push(word);
    Some(is_down)
}

/// Splits the number of a UDIM tile from a name, as in `brick_color.1002`.
fn split_tile(stem: &str) -> (&str, Option<u32>) {
    let split = stem.rsplit_once('.').and_then(|(before, number)| {
        let number = Some(number).filter(|number| number.len() == 4)?;
        let tile = number.parse().ok().filter(|tile| TILES.contains(tile))?;
        Some((before, Some(tile)))
    });
    split.unwrap_or((stem, None))
}

/// Returns whether a word describes how a file is stored: its format, or its size as in `2k`, `2048` and `2048x1024`.
fn is_stored(word: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.chars().all(|letter| letter.is_ascii_digit());
    let is_pixels = |text: &str| {
        let pixels: Option<u32> = text.parse().ok();
        pixels.is_some_and(|pixels| pixels.is_power_of_two() && (128..=16384).contains(&pixels))
    };
    let is_size = word.strip_suffix('k').is_some_and(is_number) || is_pixels(word);
    let is_rectangle = word
        .split_once('x')
        .is_some_and(|(width, height)| is_pixels(width) && is_pixels(height));
    is_size || is_rectangle || STORED.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Describes set and channels of a name: `occlusion=r`, with `!` for inverted values, `↓` for green that points down,
    /// and `?` for channels that are read only if the image has alpha.
    fn told(name: &str) -> Option<(String, String)> {
        let name = MapName::of(Path::new(name))?;
        let readings = name.readings.iter().map(|reading| {
            let output = reading.output.unwrap_or("color");
            let inverted = if reading.is_inverted { "!" } else { "" };
            let down = if reading.is_green_down { "↓" } else { "" };
            let unsure = if reading.needs_alpha { "?" } else { "" };
            format!("{}={inverted}{output}{down}{unsure}", reading.channel)
        });
        Some((name.set, readings.collect::<Vec<_>>().join(" ")))
    }

    #[test]
    fn names_of_common_libraries_give_set_and_map() {
        let known = [
            ("Bricks001_2K-JPG_Color.jpg", "bricks001", "base_color=color"),
            ("Bricks001_2K-JPG_NormalGL.jpg", "bricks001", "slope=slope"),
            ("Bricks001_2K-JPG_NormalDX.jpg", "bricks001", "slope=slope↓"),
            ("Bricks001_2K-JPG_AmbientOcclusion.jpg", "bricks001", "occlusion=mask"),
            ("Metal032_1K_Metalness.png", "metal032", "metallic=mask"),
            ("Metal032_1K_Displacement.png", "metal032", "height=mask"),
            ("rusty_metal_02_diff_4k.jpg", "rusty_metal_02", "base_color=color"),
            ("rusty_metal_02_nor_gl_4k.exr", "rusty_metal_02", "slope=slope"),
            ("rusty_metal_02_nor_dx_4k.exr", "rusty_metal_02", "slope=slope↓"),
            ("rusty_metal_02_rough_4k.exr", "rusty_metal_02", "roughness=mask"),
            ("rusty_metal_02_ao_4k.jpg", "rusty_metal_02", "occlusion=mask"),
            (
                "rusty_metal_02_arm_4k.jpg",
                "rusty_metal_02",
                "occlusion=r roughness=g metallic=b",
            ),
            ("wall_rma.png", "wall", "roughness=r metallic=g occlusion=b"),
            ("Floor_Normal_OpenGL.png", "floor", "slope=slope"),
            ("Floor_Ambient_occlusion.png", "floor", "occlusion=mask"),
            ("old-planks-height-2048.png", "old_planks", "height=mask"),
            ("leaf opacity.png", "leaf", "alpha=mask"),
            ("lamp_emissive.png", "lamp", "emission=color"),
        ];
        for (name, set, map) in known {
            assert_eq!(told(name), Some((set.to_owned(), map.to_owned())), "{name}");
        }
        assert_eq!(
            MapName::of(Path::new("albedo.png")).map(|name| name.set),
            Some(String::new())
        );
    }

    #[test]
    fn names_and_packings_of_the_presets_are_recognized() {
        let known = [
            ("T_old_crate_BC.png", "base_color=color alpha=alpha"),
            ("T_old_crate_ORM.png", "occlusion=r roughness=g metallic=b"),
            ("T_old_crate_N.png", "slope=slope↓"),
            ("T_old_crate_H.png", "height=mask"),
            ("T_old_crate_E.png", "emission=color"),
            ("old_crate_BaseMap.png", "base_color=color alpha=alpha"),
            ("old_crate_MaskMap.png", "metallic=r occlusion=g roughness=!alpha"),
            (
                "old_crate_OcclusionRoughnessMetallic.png",
                "occlusion=r roughness=g metallic=b",
            ),
            ("old_crate_base_color.png", "base_color=color alpha=alpha"),
            ("old_crate_coat_roughness.png", "coat_roughness=mask"),
            ("old_crate_ClearcoatRoughness.png", "coat_roughness=mask"),
            // glTF stores the roughness in alpha. The raw maps and the presets for Blender and MaterialX have a separate image for it.
            ("old_crate_sheen.png", "sheen=color sheen_roughness=alpha?"),
            ("old_crate_sheen_roughness.png", "sheen_roughness=mask"),
            ("old_crate_transmission.png", "transmission=mask"),
            ("old_crate_world_normal.png", ""),
            ("old_crate_anisotropy.png", ""),
        ];
        for (name, map) in known {
            assert_eq!(told(name), Some(("old_crate".to_owned(), map.to_owned())), "{name}");
        }
    }

    #[test]
    fn every_image_of_every_preset_is_recognized_by_its_name() {
        for PresetPicture {
            before, name, parts, ..
        } in preset_pictures()
        {
            let file = format!("{before}old_crate_{name}.png");
            let found = MapName::of(Path::new(&file)).unwrap_or_else(|| panic!("{file} is not known"));
            assert_eq!(found.set, "old_crate", "{file}");
            let wanted = parts.iter().filter_map(|part| part.channel.as_deref());
            for channel in wanted.filter(|channel| *channel != "anisotropy") {
                let input = match channel {
                    "opacity" => "alpha",
                    "normal" => "slope",
                    channel => channel,
                };
                assert!(
                    found.readings.iter().any(|reading| reading.channel == input),
                    "{file}: {channel}"
                );
            }
        }
    }

    #[test]
    fn udim_tiles_are_recognized_by_their_number() {
        let tile = |name: &str| MapName::of(Path::new(name)).and_then(|name| name.tile);
        assert_eq!(tile("T_old_crate_BC.1012.png"), Some(1012));
        assert_eq!(tile("old_crate_color_1024.png"), None, "a size");
    }

    #[test]
    fn other_names_are_not_recognized_as_maps() {
        for name in [
            "preview.png",
            "color_chart_photo.jpg",
            "bricks_color_gl.png",
            "letter_e.png",
            "plan_n.png",
            "2k.png",
            ".png",
            "gl.png",
        ] {
            assert_eq!(told(name), None, "{name}");
        }
    }
}
