//! Files of a set: their components, and their encoding.

use std::sync::Arc;

use crate::encode::{CodeMapping, ComponentPlane, FileEncoding, encode};
use crate::encoded_files::{self, EncodedFiles};
use crate::held_channels::{HeldChannel, HeldSet, is_whole_size};
use crate::model_copy::{MapFile, WrittenMap};
use crate::preset::{Component, ComponentSource, Map, NormalY, Preset};
use crate::resize::resized;
use crate::{Channel, ChannelPixels, ConstantValue, CutMap, EngineFormat, ExportError, MeshMap, OutputRecord};

/// The set of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileSet<'a> {
    /// Stem of its files: the material.
    pub(super) name: &'a str,
    /// UDIM number, when the material uses several tiles.
    pub(super) udim: Option<u32>,
    /// Pixels across and down.
    pub(super) size: u32,
}

/// Values of the channel of a component.
#[derive(Clone, Copy, Debug)]
pub(super) enum ComponentValues<'a> {
    /// Those of its pixels.
    Pixels(&'a HeldChannel),
    /// One value everywhere.
    Same(ConstantValue),
}

/// A file that is to be written.
pub(super) struct WantedFile<'a> {
    pub(super) map: &'a Map,
    pub(super) preset: &'a Preset,
    pub(super) name: String,
    /// Components with the values of their channels.
    pub(super) sources: Vec<(Component, ComponentValues<'a>)>,
    /// Divisor of its values; 1 but for normalized ones above 1.
    pub(super) scale: f32,
}

impl WantedFile<'_> {
    /// Encodes the file for a set; also returns its bytes. `keeps_bytes` is true if the copy of the model may use it.
    pub(super) fn encode(
        &self,
        set: FileSet<'_>,
        dither_seed: u32,
        keeps_bytes: bool,
        kept: Option<&dyn EncodedFiles>,
    ) -> Result<EncodedFile, ExportError> {
        let WantedFile { map, sources, .. } = self;
        let size = map.pixels(set.size);
        let fitted: Vec<Option<ChannelPixels>> = sources
            .iter()
            .map(|(_, values)| match values {
                ComponentValues::Pixels(held) if !is_whole_size(map) => Some(resized(&held.pixels, set.size, size)),
                _ => None,
            })
            .collect();
        let planes: Vec<ComponentPlane<'_>> = sources
            .iter()
            .zip(&fitted)
            .map(|((component, values), fitted)| match values {
                ComponentValues::Pixels(held) => {
                    let pixels = fitted.as_ref().unwrap_or(&held.pixels);
                    self.plane(component, held, pixels, dither_seed)
                }
                ComponentValues::Same(value) => ComponentPlane::Constant(self.code_of_value(component, *value)),
            })
            .collect();
        let encoding = FileEncoding {
            size,
            format: map.format,
            is_srgb: map.is_srgb,
        };
        let (bytes, was_kept) = self.bytes(&planes, encoding, kept)?;
        let record = self.record(set, &bytes);
        let bytes = Arc::new(bytes);
        let file = keeps_bytes.then(|| self.written_map(bytes.clone()));
        Ok((StagedMap { record, file, was_kept }, bytes))
    }

    /// Returns the values of its channel that the file cannot hold; `material` is the stem of its set.
    pub(super) fn cut(&self, material: &str) -> Option<CutMap> {
        let is_held = |channel: &Channel| {
            let maps = self.preset.maps_of(channel);
            maps.into_iter().any(|map| !map.format.is_whole() || map.is_normalized)
        };
        let cut = |(component, values): &(Component, ComponentValues<'_>)| match (&component.source, values) {
            (
                ComponentSource::Channel(channel @ (Channel::Emission | Channel::Color(_)), _),
                ComponentValues::Pixels(held),
            ) if held.is_above_one() && !is_held(channel) => Some((channel.clone(), held.peak)),
            _ => None,
        };
        let (channel, peak) = self.sources.iter().find_map(cut)?;
        self.map.format.is_whole().then(|| CutMap {
            path: self.name.clone(),
            preset: self.preset.name.clone(),
            channel,
            material: material.to_owned(),
            peak,
        })
    }

    /// The file with these bytes, for the copy of the model.
    fn written_map(&self, bytes: Arc<Vec<u8>>) -> WrittenMap {
        let map = self.map;
        WrittenMap {
            components: self.sources.iter().map(|(component, _)| component.clone()).collect(),
            is_srgb: map.is_srgb,
            is_dithered: map.is_dithered,
            format: map.format,
            is_whole_size: is_whole_size(map),
            normal_y: self.preset.normal_y,
            scale: self.scale,
            file: MapFile {
                name: self.name.clone(),
                bytes,
                is_written: true,
            },
        }
    }

    /// The bytes of planes, and whether an earlier bake had encoded them.
    fn bytes(
        &self,
        planes: &[ComponentPlane<'_>],
        encoding: FileEncoding,
        kept: Option<&dyn EncodedFiles>,
    ) -> Result<(Vec<u8>, bool), ExportError> {
        let key = kept.map(|kept| (kept, encoded_files::key(planes, encoding)));
        if let Some(bytes) = key.and_then(|(kept, key)| kept.find(&key)) {
            return Ok((bytes, true));
        }
        let bytes = encode(planes, encoding).map_err(|source| ExportError::Encode {
            file_name: self.name.clone(),
            source,
        })?;
        if let Some((kept, key)) = key {
            kept.keep(&key, &bytes);
        }
        Ok((bytes, false))
    }

    /// Entry of the report for the file with these bytes.
    fn record(&self, set: FileSet<'_>, bytes: &[u8]) -> OutputRecord {
        let WantedFile {
            map, preset, sources, ..
        } = self;
        let size = map.pixels(set.size);
        let components: Vec<Component> = sources.iter().map(|(component, _)| component.clone()).collect();
        let engine_format = EngineFormat::of(&components, map.format);
        OutputRecord {
            path: self.name.clone(),
            preset: preset.name.clone(),
            channel: single_channel(sources).map_or_else(|| map.name.clone(), |channel| channel.name().into_owned()),
            components: components.iter().map(ToString::to_string).collect(),
            material: set.name.to_owned(),
            udim: set.udim,
            width: size[0],
            height: size[1],
            bits: map.format.bits(),
            color_space: if map.is_srgb { "srgb" } else { "linear" },
            range: height_range(map, sources),
            scale: (self.scale > 1.0).then_some(self.scale),
            engine_format,
            engine_bytes: engine_format.bytes(size),
            blake3: blake3::hash(bytes).to_hex().to_string(),
        }
    }

    /// A component with pixels as the encoder takes it.
    fn plane<'p>(
        &self,
        component: &Component,
        held: &HeldChannel,
        pixels: &'p ChannelPixels,
        dither_seed: u32,
    ) -> ComponentPlane<'p> {
        let (channel, index) = match &component.source {
            ComponentSource::Constant(value) => return ComponentPlane::Constant(*value),
            // None, once the preset has the outputs of the graph.
            ComponentSource::Output(..) => {
                return ComponentPlane::Constant(if component.is_inverted { 1.0 } else { 0.0 });
            }
            ComponentSource::Channel(channel, index) => (channel, *index),
        };
        let range = [held.low[0], held.high[0]];
        ComponentPlane::Channel {
            pixels,
            index,
            codes: match channel {
                Channel::Normal => CodeMapping::Normal {
                    is_down: self.preset.normal_y == NormalY::Down,
                },
                Channel::Height if self.map.is_normalized => CodeMapping::Normalized(range),
                Channel::Height => CodeMapping::Range(range),
                Channel::Mesh(MeshMap::WorldNormal | MeshMap::BentNormal) => CodeMapping::Direction,
                Channel::Mesh(MeshMap::Curvature) => CodeMapping::Signed,
                _ if self.scale > 1.0 => CodeMapping::Scaled(self.scale),
                _ => CodeMapping::Unit,
            },
            is_inverted: component.is_inverted,
            dither: self.map.is_dithered.then(|| channel.dither_pattern(index, dither_seed)),
        }
    }

    /// Returns the number that a file has for a component with the same value everywhere. A height is itself in a file
    /// of floats, and 0, the lowest of its range, in whole numbers and normalized files.
    fn code_of_value(&self, component: &Component, value: ConstantValue) -> f32 {
        let (channel, index) = match &component.source {
            ComponentSource::Constant(value) => return *value,
            // None, once the preset has the outputs of the graph.
            ComponentSource::Output(..) => return if component.is_inverted { 1.0 } else { 0.0 },
            ComponentSource::Channel(channel, index) => (channel, *index),
        };
        let value = value.component(index);
        let unit = match channel {
            Channel::Normal | Channel::Mesh(MeshMap::WorldNormal | MeshMap::BentNormal | MeshMap::Curvature) => {
                value * 0.5 + 0.5
            }
            Channel::Height if !(self.map.format.is_whole() || self.map.is_normalized) => return value,
            Channel::Height => 0.0,
            _ => value / self.scale,
        };
        if component.is_inverted { 1.0 - unit } else { unit }
    }
}

/// The components of a map with the values of their channels, without an alpha that is 1 everywhere; `values` gives those
/// of a channel.
pub(super) fn sources<'a>(
    components: &[Component],
    values: impl Fn(&Channel) -> ComponentValues<'a>,
) -> Vec<(Component, ComponentValues<'a>)> {
    let source = |component: &Component| match &component.source {
        ComponentSource::Channel(channel, _) => (component.clone(), values(channel)),
        // None, once the preset has the outputs of the graph.
        ComponentSource::Output(..) => (component.clone(), ComponentValues::Same(ConstantValue::Number(0.0))),
        ComponentSource::Constant(value) => (component.clone(), ComponentValues::Same(ConstantValue::Number(*value))),
    };
    let mut found: Vec<(Component, ComponentValues<'_>)> = components.iter().map(source).collect();
    // Programs take a map with an alpha channel for one that is cut out.
    if let [_, _, _, (component, values)] = &found[..]
        && is_opaque(component, values)
    {
        found.pop();
    }
    found
}

/// The values of a channel in a set: the neutral one where the material does not have it.
pub(super) fn held_values<'a>(held: &'a HeldSet, channel: &Channel) -> ComponentValues<'a> {
    match held.channel(channel) {
        Some(held) => ComponentValues::Pixels(held),
        None => ComponentValues::Same(ConstantValue::neutral(channel)),
    }
}

/// A file with its bytes, before it is staged.
pub(super) type EncodedFile = (StagedMap, Arc<Vec<u8>>);

/// A file that was staged.
pub(super) struct StagedMap {
    pub(super) record: OutputRecord,
    /// For the copy of the model, if one is made.
    pub(super) file: Option<WrittenMap>,
    /// True if the bytes are those of an earlier bake.
    pub(super) was_kept: bool,
}

/// Returns true if a component is an opacity of 1 everywhere.
fn is_opaque(component: &Component, values: &ComponentValues<'_>) -> bool {
    let constant = match values {
        ComponentValues::Pixels(held) => held.constant,
        ComponentValues::Same(value) => Some(*value),
    };
    let is_opacity = matches!(component.source, ComponentSource::Channel(Channel::Opacity, _));
    let is_one = |value: ConstantValue| match component.is_inverted {
        true => 1.0 - value.component(0) >= 1.0,
        false => value.component(0) >= 1.0,
    };
    is_opacity && constant.is_some_and(is_one)
}

/// The channel of a file that has one alone.
fn single_channel<'s>(sources: &'s [(Component, ComponentValues<'_>)]) -> Option<&'s Channel> {
    let channel = |source: &'s (Component, _)| match &source.0.source {
        ComponentSource::Channel(channel, _) => Some(channel),
        ComponentSource::Output(..) | ComponentSource::Constant(_) => None,
    };
    let first = channel(sources.first()?)?;
    sources
        .iter()
        .all(|source| channel(source) == Some(first))
        .then_some(first)
}

/// Heights of the lowest and highest code, for heights in whole numbers.
fn height_range(map: &Map, sources: &[(Component, ComponentValues<'_>)]) -> Option<[f32; 2]> {
    let is_height = |component: &Component| matches!(component.source, ComponentSource::Channel(Channel::Height, _));
    let (_, values) = sources.iter().find(|(component, _)| is_height(component))?;
    match values {
        _ if !(map.format.is_whole() || map.is_normalized) => None,
        ComponentValues::Pixels(held) => Some([held.low[0], held.high[0]]),
        ComponentValues::Same(value) => Some([value.component(0); 2]),
    }
}
