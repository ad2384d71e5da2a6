//! Names and contents of the pictures that the presets write, by which an import recognizes them.

use std::ops::Range;

use sabi_export::Channel;
use sabi_export::preset::{BUILTIN_NAMES, ComponentSource, Map, MapContent, NormalY, Preset, builtin};

/// Picture that a preset of Sabi writes for a material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PresetPicture {
    /// Text of its file name before that of the material, such as `T_`.
    pub before: String,
    /// Word in its file name for its content, such as `ORM`.
    pub name: String,
    /// True if it has one color component.
    pub is_gray: bool,
    /// Contents of its components. Components that contain the same number everywhere are left out.
    pub parts: Vec<PictureChannel>,
}

/// Channel in a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureChannel {
    /// Name of the channel in reports, such as `base_color`; `None` if it is not a channel of materials.
    pub channel: Option<String>,
    /// Range of components that contain it, red first. A gray picture has one color component, and its alpha is the second.
    pub components: Range<usize>,
    /// True if the picture stores 1 minus the value.
    pub is_inverted: bool,
    /// True for normals whose green points downward.
    pub is_green_down: bool,
    /// True if it is the alpha of the picture.
    pub is_alpha: bool,
}

/// Lists the pictures of all built-in presets, without repeated names. Files of the graph's outputs have their own names
/// and are not listed.
pub fn preset_pictures() -> Vec<PresetPicture> {
    let presets = BUILTIN_NAMES.into_iter().filter_map(|name| builtin(name)?.ok());
    let mut found = Vec::new();
    for preset in presets {
        for map in &preset.maps {
            if let Some(picture) = picture(&preset, map).filter(|picture| !found.contains(picture)) {
                found.push(picture);
            }
        }
    }
    found
}

fn picture(preset: &Preset, map: &Map) -> Option<PresetPicture> {
    let MapContent::Packed(components) = &map.content else {
        return None;
    };
    // A pattern that begins with a token has no text before it.
    let first = preset.names.find(['$', '{', '(']).unwrap_or(preset.names.len());
    let before = &preset.names[..first];
    // Gray pictures, with or without alpha, have one color component; the others have three.
    let colors = if components.len() < 3 { 1 } else { 3 };
    let mut parts = Vec::new();
    let mut at = 0;
    while let Some(component) = components.get(at) {
        let ComponentSource::Channel(channel, 0) = &component.source else {
            at += 1;
            continue;
        };
        let is_next = |next: usize| {
            let source = components.get(at + next).map(|component| &component.source);
            matches!(source, Some(ComponentSource::Channel(same, index)) if same == channel && *index == next)
        };
        // A channel of three components may be stored by its first component alone.
        let count = (1..channel.components()).take_while(|next| is_next(*next)).count() + 1;
        let is_whole = count == channel.components();
        let is_material = !matches!(channel, Channel::Mesh(_)) && channel.output_kind().is_none();
        parts.push(PictureChannel {
            channel: (is_material && is_whole).then(|| channel.name().into_owned()),
            components: at..at + count,
            is_inverted: component.is_inverted,
            is_green_down: *channel == Channel::Normal && preset.normal_y == NormalY::Down,
            is_alpha: at >= colors,
        });
        at += count;
    }
    Some(PresetPicture {
        before: before.to_owned(),
        name: map.name.clone(),
        is_gray: colors == 1,
        parts,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(before: &str, name: &str) -> Vec<(String, Range<usize>, bool)> {
        let pictures = preset_pictures();
        let picture = pictures
            .iter()
            .find(|picture| picture.before == before && picture.name == name)
            .expect("a picture of a preset");
        let part = |part: &PictureChannel| {
            let channel = part.channel.clone().unwrap_or_default();
            (channel, part.components.clone(), part.is_inverted)
        };
        picture.parts.iter().map(part).collect()
    }

    #[test]
    fn pictures_of_presets_show_where_each_channel_is() {
        let part = |channel: &str, components: Range<usize>| (channel.to_owned(), components, false);
        assert_eq!(
            parts("T_", "ORM"),
            [part("occlusion", 0..1), part("roughness", 1..2), part("metallic", 2..3)]
        );
        assert_eq!(parts("T_", "BC"), [part("base_color", 0..3), part("opacity", 3..4)]);
        // 0.5 in blue is no channel.
        assert_eq!(
            parts("", "MaskMap"),
            [
                part("metallic", 0..1),
                part("occlusion", 1..2),
                ("roughness".to_owned(), 3..4, true)
            ]
        );
        assert_eq!(parts("", "world_normal"), [part("", 0..3)], "no channel of materials");
    }

    #[test]
    fn green_points_down_in_the_normals_of_unreal_alone() {
        let down: Vec<String> = preset_pictures()
            .into_iter()
            .filter(|picture| picture.parts.iter().any(|part| part.is_green_down))
            .map(|picture| picture.before + &picture.name)
            .collect();
        assert_eq!(down, ["T_N"]);
    }
}
