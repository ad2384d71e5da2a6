//! Materials as used in documents: the tiles of a material combined, its channels as files or values.

use std::collections::BTreeMap;

use super::facts::SetFacts;
use super::identifiers::Identifiers;
use crate::held_channels::MapIndex;
use crate::layout::SetKey;
use crate::name_pattern::{NameParts, NamePattern};
use crate::preset::{Component, ComponentSource, Map, MapFormat, Preset};
use crate::{Channel, ConstantValue};

/// Placeholder for the number of a tile, in MaterialX and USD.
const TILES: &str = "<UDIM>";

/// Material of a document.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DocumentMaterial {
    /// Stem of the files: the material.
    pub(crate) name: String,
    /// The name as an identifier.
    pub(super) id: String,
    /// UV set of the geometry that the maps are for.
    pub(super) uv_set: u32,
    /// Files that it uses.
    pub(super) maps: Vec<DocumentMap>,
    /// Channels of the material, except those without effect.
    pub(super) channels: BTreeMap<Channel, ChannelSource>,
    /// Channels that vary and for which the preset has no file that a document can use.
    pub(crate) missing: Vec<Channel>,
}

/// File that a material uses.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DocumentMap {
    /// The word for the map in the preset, as an identifier.
    pub(super) id: String,
    /// File name, with `<UDIM>` in place of the numbers of tiles.
    pub(super) file: String,
    /// Names of the files of all tiles.
    pub(super) files: Vec<String>,
    /// Number of its components.
    pub(super) components: usize,
    /// True if the sRGB curve was applied to all components except alpha.
    pub(super) is_srgb: bool,
    /// Scale and bias to compute the value of each component from the number in the file.
    pub(super) decoding: [[f32; 2]; 4],
}

/// Origin of a channel's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ChannelSource {
    /// The same value everywhere, linear.
    Value(ConstantValue),
    /// The red, green and blue components of a file.
    Rgb(usize),
    /// One component of a file.
    Component {
        /// Index of the file.
        map: usize,
        /// Component, from 0.
        index: usize,
    },
}

/// A preset with the names of its files, and the selection of files that a document may use.
#[derive(Clone, Copy)]
pub(crate) struct PresetFiles<'a> {
    /// Number of the preset among those of the bake.
    pub(crate) index: usize,
    pub(crate) preset: &'a Preset,
    pub(crate) names: &'a NamePattern,
    pub(crate) takes: &'a dyn Fn(MapFormat) -> bool,
    /// UV set of the maps of a material.
    pub(crate) uv_set: &'a dyn Fn(u32) -> u32,
}

/// Materials of the sets of a bake, by the number of the material.
pub(crate) fn materials(facts: &BTreeMap<SetKey, SetFacts>, files: PresetFiles<'_>) -> Vec<DocumentMaterial> {
    let mut tiles: BTreeMap<u32, Vec<(&SetKey, &SetFacts)>> = BTreeMap::new();
    for (key, set) in facts {
        tiles.entry(key.material).or_default().push((key, set));
    }
    for sets in tiles.values_mut() {
        sets.sort_by_key(|(key, _)| key.udim);
    }
    let mut identifiers = Identifiers::default();
    let material = |tiles: &Vec<(&SetKey, &SetFacts)>| {
        let (key, set) = tiles.first()?;
        let mut made = MaterialSets {
            sets: tiles.iter().map(|(_, set)| *set).collect(),
            is_udim: key.udim.is_some(),
            files,
            maps: Vec::new(),
            map_identifiers: Identifiers::without(&["Surface", "Texcoord"]),
        };
        let (channels, missing) = made.channels();
        Some(DocumentMaterial {
            name: set.name.clone(),
            id: identifiers.add(&set.name, "material"),
            uv_set: (files.uv_set)(key.material),
            maps: made.maps.into_iter().map(|(_, map)| map).collect(),
            channels,
            missing,
        })
    };
    tiles.values().filter_map(material).collect()
}

/// The sets of one material.
struct MaterialSets<'a> {
    sets: Vec<&'a SetFacts>,
    /// True if the material has several tiles with a set each.
    is_udim: bool,
    files: PresetFiles<'a>,
    /// Files used by its channels so far, with their number in the preset.
    maps: Vec<(usize, DocumentMap)>,
    map_identifiers: Identifiers,
}

impl MaterialSets<'_> {
    /// Returns the channels with their origins, and the channels without one.
    fn channels(&mut self) -> (BTreeMap<Channel, ChannelSource>, Vec<Channel>) {
        let mut channels = BTreeMap::new();
        let mut missing = Vec::new();
        for channel in Channel::ALL {
            let has_it = self.sets.iter().any(|set| set.channels.contains_key(&channel));
            // The roughness of a layer is omitted together with the layer.
            let layer = match channel {
                Channel::CoatRoughness => Some(Channel::Coat),
                Channel::SheenRoughness => Some(Channel::Sheen),
                _ => None,
            };
            if let Some(layer) = layer.filter(|layer| has_it && !channels.contains_key(layer)) {
                missing.extend(missing.contains(&layer).then_some(channel));
                continue;
            }
            if !has_it {
                continue;
            }
            let value = self.value(&channel);
            if value.is_some_and(|value| changes_nothing(&channel, value)) {
                continue;
            }
            match self.file(&channel).or(value.map(ChannelSource::Value)) {
                // A normal map is written for every material, but a flat normal needs no map.
                Some(ChannelSource::Value(_)) if channel == Channel::Normal => {}
                Some(look) => drop(channels.insert(channel, look)),
                None => missing.push(channel),
            }
        }
        (channels, missing)
    }

    /// Returns the value of a channel that is the same everywhere in all tiles.
    fn value(&self, channel: &Channel) -> Option<ConstantValue> {
        let mut values = self.sets.iter().map(|set| set.constant(channel));
        let first = values.next()??;
        values.all(|value| value == Some(first)).then_some(first)
    }

    /// Returns the best file with the channel: floats before integers, more bits before fewer, then the first one.
    fn file(&mut self, channel: &Channel) -> Option<ChannelSource> {
        let maps = self.files.preset.maps.iter().enumerate();
        let mut found: Vec<(usize, &Map)> = maps
            .filter(|(_, map)| map.has(channel) && (self.files.takes)(map.format))
            .collect();
        found.sort_by_key(|(_, map)| (map.format.is_whole(), std::cmp::Reverse(map.format.bits())));
        found.into_iter().find_map(|(at, map)| self.look(channel, at, map))
    }

    /// Returns the channel in a file; `None` if a tile lacks the file, or if documents cannot read the channel from it.
    fn look(&mut self, channel: &Channel, at: usize, map: &Map) -> Option<ChannelSource> {
        let components = self.components([self.files.index, at])?;
        let place = |wanted: usize| {
            components.iter().position(|component| {
                matches!(&component.source, ComponentSource::Channel(held, index) if held == channel && *index == wanted)
            })
        };
        if channel.components() == 3 {
            let is_plain = |index: &usize| place(*index) == Some(*index) && !components[*index].is_inverted;
            let is_rgb = components.len() >= 3 && (0..3).all(|index| is_plain(&index));
            if !is_rgb || self.scale([self.files.index, at]).is_none() {
                return None;
            }
            return self.map(at, map, &components).map(ChannelSource::Rgb);
        }
        let index = place(0)?;
        // Programs differ in which component of a gray image they read as alpha.
        let is_readable = components.len() != 2 || index == 0;
        let is_height = *channel == Channel::Height;
        let is_one_range = !is_height || self.decoding(&components[index], at, map).is_some();
        if !is_readable || !is_one_range {
            return None;
        }
        let map = self.map(at, map, &components)?;
        Some(ChannelSource::Component { map, index })
    }

    /// Returns the components of a file that every tile has. Some tiles lack an alpha that would be 1.
    fn components(&self, index: MapIndex) -> Option<Vec<Component>> {
        let files = self.sets.iter().map(|set| set.files.get(&index));
        let all: Vec<&[Component]> = files.map(|file| Some(&file?.components[..])).collect::<Option<_>>()?;
        let longest = all.iter().max_by_key(|components| components.len())?;
        let is_alike = all.iter().all(|components| longest.starts_with(components));
        is_alike.then(|| longest.to_vec())
    }

    /// The index of a file among those of the material.
    fn map(&mut self, at: usize, map: &Map, components: &[Component]) -> Option<usize> {
        let known = self.maps.iter().position(|(known, _)| *known == at);
        if known.is_some() {
            return known;
        }
        let index = [self.files.index, at];
        let written = self.sets.iter().filter_map(|set| set.files.get(&index));
        let files: Vec<String> = written.map(|file| file.name.clone()).collect();
        let mut decoding = [[1.0, 0.0]; 4];
        for (place, component) in decoding.iter_mut().zip(components) {
            // If the tiles differ in the range of a height, it is not read from the file.
            *place = self.decoding(component, at, map).unwrap_or([1.0, 0.0]);
        }
        let made = DocumentMap {
            id: self.map_identifiers.add(&map.name, "map"),
            file: self.file_of_tiles(map).or_else(|| files.first().cloned())?,
            files,
            components: components.len(),
            is_srgb: map.is_srgb,
            decoding,
        };
        self.maps.push((at, made));
        Some(self.maps.len() - 1)
    }

    /// Returns the name of a file with `<UDIM>` in place of the numbers; `None` for a material with one tile.
    fn file_of_tiles(&self, map: &Map) -> Option<String> {
        let set = self.sets.first().filter(|_| self.is_udim)?;
        let parts = NameParts {
            material: &set.name,
            map: &map.name,
            udim: None,
            size: map.pixels(set.size),
        };
        let stem = self.files.names.name_of_tiles(&parts, TILES);
        Some(format!("{stem}.{}", map.format.ending()))
    }

    /// Returns the divisor of the values of a file; `None` if the tiles have different ones.
    fn scale(&self, index: MapIndex) -> Option<f32> {
        let mut scales = self.sets.iter().filter_map(|set| Some(set.files.get(&index)?.scale));
        // If no tile has the file, it is not read.
        let first = scales.next().unwrap_or(1.0);
        scales.all(|scale| scale == first).then_some(first)
    }

    /// Returns scale and bias of a component: integers span the range of a height, and inverted values are inverted back.
    /// `None` if the ranges of the tiles differ where it matters.
    fn decoding(&self, component: &Component, at: usize, map: &Map) -> Option<[f32; 2]> {
        let is_height = matches!(component.source, ComponentSource::Channel(Channel::Height, _));
        let spans_range = map.format.is_whole() || map.is_normalized;
        if !is_height || (!component.is_inverted && !spans_range) {
            let sign = if component.is_inverted { -1.0 } else { 1.0 };
            return Some([
                sign * self.scale([self.files.index, at])?,
                if component.is_inverted { 1.0 } else { 0.0 },
            ]);
        }
        let range = |set: &&SetFacts| set.channels.get(&Channel::Height).map(|facts| facts.range);
        let mut ranges = self.sets.iter().map(range);
        let [low, high] = ranges.next()??;
        if !ranges.all(|range| range == Some([low, high])) {
            return None;
        }
        Some(match (spans_range, component.is_inverted) {
            (true, false) => [high - low, low],
            (true, true) => [low - high, high],
            (false, _) => [-1.0, low + high],
        })
    }
}

/// Returns true if omitting the value from a document has no effect.
pub(crate) fn changes_nothing(channel: &Channel, value: ConstantValue) -> bool {
    match channel {
        Channel::BaseColor
        | Channel::Roughness
        | Channel::Metallic
        | Channel::Normal
        | Channel::CoatRoughness
        | Channel::SheenRoughness => false,
        Channel::Anisotropy => value.component(2) == 0.0,
        _ => value == ConstantValue::neutral(channel),
    }
}
