//! Sets and channels that the names of texture files denote. Follows the conventions of ambientCG, Poly Haven,
//! cgbookcase and the exports of common tools.

use std::path::Path;

/// Content of a picture of a texture set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Map {
    Color,
    Roughness,
    Metallic,
    Occlusion,
    Height,
    /// `is_down` where green points down, as in DirectX.
    Normal {
        is_down: bool,
    },
    Alpha,
    Emission,
    /// Several channels in one picture.
    Packed,
}

/// Words that name a map, in lower case and without spaces.
const WORDS: [(Map, &[&str]); 9] = [
    (
        Map::Color,
        &["color", "col", "basecolor", "albedo", "diff", "diffuse", "base"],
    ),
    (Map::Roughness, &["roughness", "rough", "rgh"]),
    (Map::Metallic, &["metallic", "metalness", "metal", "mtl"]),
    (Map::Occlusion, &["ambientocclusion", "occlusion", "ao"]),
    (Map::Height, &["displacement", "displace", "disp", "height", "bump"]),
    (
        Map::Normal { is_down: false },
        &["normal", "normals", "normalmap", "nor", "norm", "nrm"],
    ),
    (Map::Alpha, &["opacity", "alpha", "transparency"]),
    (Map::Emission, &["emission", "emissive", "emit"]),
    (Map::Packed, &["arm", "orm", "ord", "rma", "mra"]),
];

/// Words for normal maps whose green points up.
const UP: [&str; 3] = ["gl", "opengl", "ogl"];
/// Words for normal maps whose green points down.
const DOWN: [&str; 3] = ["dx", "directx", "d3d"];
/// Words for the format of a file.
const STORED: [&str; 6] = ["jpg", "jpeg", "png", "exr", "tif", "tiff"];

/// Set and map that the name of a file denotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MapName {
    /// Name of the set in lower case.
    pub(crate) set: String,
    pub(crate) map: Map,
}

impl MapName {
    /// Parses the name of a file; none if it does not name a map.
    pub(crate) fn of(file: &Path) -> Option<MapName> {
        let stem = file.file_stem()?.to_string_lossy().to_lowercase();
        let words: Vec<&str> = stem
            .split(|letter: char| !letter.is_alphanumeric())
            .filter(|word| !word.is_empty() && !is_stored(word))
            .collect();
        let (last, mut rest) = words.split_last()?;
        let (mut word, mut is_down) = (*last, None);
        if UP.contains(&word) || DOWN.contains(&word) {
            is_down = Some(DOWN.contains(&word));
            let (before, others) = rest.split_last()?;
            (word, rest) = (*before, others);
        } else if let Some((known, down)) = directed(word) {
            (word, is_down) = (known, Some(down));
        }
        let map = match rest.split_last() {
            // Base color and ambient occlusion are often written as two words.
            Some((before, others)) if map_of(&format!("{before}{word}")).is_some() => {
                let both = map_of(&format!("{before}{word}"));
                rest = others;
                both?
            }
            _ => map_of(word)?,
        };
        let map = match (map, is_down) {
            (Map::Normal { .. }, Some(is_down)) => Map::Normal { is_down },
            (map, None) => map,
            // Only normal maps have a direction.
            (_, Some(_)) => return None,
        };
        Some(MapName {
            set: rest.join("_"),
            map,
        })
    }
}

fn map_of(word: &str) -> Option<Map> {
    let (map, _) = WORDS.iter().find(|(_, words)| words.contains(&word))?;
    Some(*map)
}

/// Splits a word such as `normalgl` into the map and its direction.
fn directed(word: &str) -> Option<(&str, bool)> {
    let cut = |ends: &[&str]| ends.iter().find_map(|end| word.strip_suffix(end));
    let is_normal = |word: &&str| matches!(map_of(word), Some(Map::Normal { .. }));
    let up = cut(&UP).filter(is_normal).map(|word| (word, false));
    up.or_else(|| cut(&DOWN).filter(is_normal).map(|word| (word, true)))
}

/// Returns whether a word describes how a file is stored: its format, or its size as in `2k`.
fn is_stored(word: &str) -> bool {
    let size = word.strip_suffix('k').unwrap_or("");
    let is_size = !size.is_empty() && size.chars().all(|letter| letter.is_ascii_digit());
    is_size || STORED.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str) -> Option<(String, Map)> {
        MapName::of(Path::new(name)).map(|name| (name.set, name.map))
    }

    #[test]
    fn names_of_common_libraries_say_set_and_map() {
        let up = Map::Normal { is_down: false };
        let down = Map::Normal { is_down: true };
        let known = [
            ("Bricks001_2K-JPG_Color.jpg", "bricks001", Map::Color),
            ("Bricks001_2K-JPG_NormalGL.jpg", "bricks001", up),
            ("Bricks001_2K-JPG_NormalDX.jpg", "bricks001", down),
            ("Bricks001_2K-JPG_AmbientOcclusion.jpg", "bricks001", Map::Occlusion),
            ("Metal032_1K_Metalness.png", "metal032", Map::Metallic),
            ("Metal032_1K_Displacement.png", "metal032", Map::Height),
            ("rusty_metal_02_diff_4k.jpg", "rusty_metal_02", Map::Color),
            ("rusty_metal_02_nor_gl_4k.exr", "rusty_metal_02", up),
            ("rusty_metal_02_nor_dx_4k.exr", "rusty_metal_02", down),
            ("rusty_metal_02_rough_4k.exr", "rusty_metal_02", Map::Roughness),
            ("rusty_metal_02_ao_4k.jpg", "rusty_metal_02", Map::Occlusion),
            ("rusty_metal_02_arm_4k.jpg", "rusty_metal_02", Map::Packed),
            ("Floor_Base_Color.png", "floor", Map::Color),
            ("Floor_Normal_OpenGL.png", "floor", up),
            ("Floor_Ambient_occlusion.png", "floor", Map::Occlusion),
            ("old-planks-height.png", "old_planks", Map::Height),
            ("leaf opacity.png", "leaf", Map::Alpha),
            ("lamp_emissive.png", "lamp", Map::Emission),
            ("albedo.png", "", Map::Color),
        ];
        for (name, set, map) in known {
            assert_eq!(told(name), Some((set.to_owned(), map)), "{name}");
        }
    }

    #[test]
    fn other_names_are_those_of_no_map() {
        for name in [
            "preview.png",
            "color_chart_photo.jpg",
            "bricks_color_gl.png",
            "2k.png",
            ".png",
            "gl.png",
        ] {
            assert_eq!(told(name), None, "{name}");
        }
    }
}
