//! Files of a set: their components, and their encoding.

use std::sync::Arc;

use crate::encode::{Codes, Encoding, Plane, encode};
use crate::encoded_files::{self, EncodedFiles};
use crate::held::{HeldChannel, HeldSet, is_whole_size};
use crate::layout::SetLayout;
use crate::model_copy::{MapFile, WrittenMap};
use crate::preset::{Component, ComponentSource, Map, NormalY, Preset};
use crate::resize::resized;
use crate::{Channel, ChannelPixels, ExportError, OutputRecord};

/// A file that is to be written.
pub(super) struct WantedFile<'a> {
    pub(super) map: &'a Map,
    pub(super) preset: &'a Preset,
    pub(super) name: String,
    /// Components with the channels that they are of, where the material has these.
    pub(super) sources: Vec<(Component, Option<&'a HeldChannel>)>,
}

impl WantedFile<'_> {
    /// Encodes the file for a set; also returns its bytes. `keeps_bytes` is true if the copy of the model may use it.
    pub(super) fn encode(
        &self,
        layout: &SetLayout,
        material: &str,
        keeps_bytes: bool,
        kept: Option<&dyn EncodedFiles>,
    ) -> Result<EncodedFile, ExportError> {
        let WantedFile {
            map, preset, sources, ..
        } = self;
        let size = map.pixels(layout.size);
        let fitted: Vec<Option<ChannelPixels>> = sources
            .iter()
            .map(|(_, held)| {
                let held = held.filter(|_| !is_whole_size(map))?;
                Some(resized(&held.pixels, layout.size, size))
            })
            .collect();
        let planes = sources.iter().zip(&fitted);
        let planes: Vec<Plane<'_>> = planes
            .map(|((component, held), fitted)| {
                let pixels = held.map(|held| fitted.as_ref().unwrap_or(&held.pixels));
                plane(component, *held, pixels, preset.normal_y)
            })
            .collect();
        let encoding = Encoding {
            size,
            format: map.format,
            is_srgb: map.is_srgb,
            is_dithered: map.is_dithered,
        };
        let key = kept.map(|kept| (kept, encoded_files::key(&planes, encoding)));
        let found = key.and_then(|(kept, key)| kept.find(&key));
        let was_kept = found.is_some();
        let bytes = match found {
            Some(bytes) => bytes,
            None => {
                let bytes = encode(&planes, encoding).map_err(|source| ExportError::Encode {
                    file_name: self.name.clone(),
                    source,
                })?;
                if let Some((kept, key)) = key {
                    kept.keep(&key, &bytes);
                }
                bytes
            }
        };
        let record = self.record(layout, material, &bytes);
        let bytes = Arc::new(bytes);
        let file = keeps_bytes.then(|| WrittenMap {
            components: sources.iter().map(|(component, _)| component.clone()).collect(),
            is_srgb: map.is_srgb,
            is_dithered: map.is_dithered,
            format: map.format,
            is_whole_size: is_whole_size(map),
            normal_y: preset.normal_y,
            file: MapFile {
                name: record.path.clone(),
                bytes: bytes.clone(),
                is_written: true,
            },
        });
        Ok((WrittenFile { record, file, was_kept }, bytes))
    }

    /// Entry of the report for the file with these bytes.
    fn record(&self, layout: &SetLayout, material: &str, bytes: &[u8]) -> OutputRecord {
        let WantedFile {
            map, preset, sources, ..
        } = self;
        let size = map.pixels(layout.size);
        OutputRecord {
            path: self.name.clone(),
            preset: preset.name.clone(),
            channel: single_channel(sources).map_or_else(|| map.name.clone(), |channel| channel.name().into_owned()),
            components: sources.iter().map(|(component, _)| component.to_string()).collect(),
            material: material.to_owned(),
            udim: layout.key.udim,
            width: size[0],
            height: size[1],
            bits: map.format.bits(),
            color_space: if map.is_srgb { "srgb" } else { "linear" },
            range: height_range(map, sources),
            blake3: blake3::hash(bytes).to_hex().to_string(),
        }
    }
}

/// The components of a map with their channels, without an alpha that is 1 everywhere.
pub(super) fn sources<'a>(components: &[Component], held: &'a HeldSet) -> Vec<(Component, Option<&'a HeldChannel>)> {
    let source = |component: &Component| {
        let channel = match &component.source {
            ComponentSource::Channel(channel, _) => held.channel(channel),
            ComponentSource::Constant(_) => None,
        };
        (component.clone(), channel)
    };
    // Programs take a map with an alpha channel for one that is cut out.
    let is_opaque = |component: &Component| is_opaque(component, held);
    let kept = match components {
        [r, g, b, alpha] if is_opaque(alpha) => vec![r, g, b],
        components => components.iter().collect(),
    };
    kept.into_iter().map(source).collect()
}

/// A file with its bytes, before it is staged.
pub(super) type EncodedFile = (WrittenFile, Arc<Vec<u8>>);

/// A file that was staged.
pub(super) struct WrittenFile {
    pub(super) record: OutputRecord,
    /// For the copy of the model, if one is made.
    pub(super) file: Option<WrittenMap>,
    /// True if the bytes are those of an earlier bake.
    pub(super) was_kept: bool,
}

/// A component as the encoder takes it; the neutral value where the material does not have the channel.
fn plane<'a>(
    component: &Component,
    held: Option<&HeldChannel>,
    pixels: Option<&'a ChannelPixels>,
    normal_y: NormalY,
) -> Plane<'a> {
    let (channel, index) = match &component.source {
        ComponentSource::Constant(value) => return Plane::Constant(*value),
        ComponentSource::Channel(channel, index) => (channel, *index),
    };
    match (held, pixels) {
        (Some(held), Some(pixels)) => Plane::Channel {
            pixels,
            index,
            codes: match channel {
                Channel::Normal => Codes::Normal {
                    is_down: normal_y == NormalY::Down,
                },
                Channel::Height => Codes::Range([held.low[0], held.high[0]]),
                _ => Codes::Unit,
            },
            is_inverted: component.is_inverted,
        },
        _ => {
            // A channel has a neutral value for each of its components.
            let neutral = channel.neutral().get(index).copied().unwrap_or(0.0);
            let unit = match channel {
                Channel::Normal => neutral * 0.5 + 0.5,
                _ => neutral,
            };
            Plane::Constant(if component.is_inverted { 1.0 - unit } else { unit })
        }
    }
}

/// Returns true if a component is an opacity of 1 everywhere.
fn is_opaque(component: &Component, held: &HeldSet) -> bool {
    let is_opacity = matches!(component.source, ComponentSource::Channel(Channel::Opacity, _));
    is_opacity && held.constant(component).is_some_and(|value| value >= 1.0)
}

/// The channel of a file that has one alone.
fn single_channel<'s>(sources: &'s [(Component, Option<&HeldChannel>)]) -> Option<&'s Channel> {
    let channel = |source: &'s (Component, _)| match &source.0.source {
        ComponentSource::Channel(channel, _) => Some(channel),
        ComponentSource::Constant(_) => None,
    };
    let first = channel(sources.first()?)?;
    sources
        .iter()
        .all(|source| channel(source) == Some(first))
        .then_some(first)
}

/// Heights of the lowest and highest code, for heights in whole numbers.
fn height_range(map: &Map, sources: &[(Component, Option<&HeldChannel>)]) -> Option<[f32; 2]> {
    let is_height = |component: &Component| matches!(component.source, ComponentSource::Channel(Channel::Height, _));
    let (_, held) = sources.iter().find(|(component, _)| is_height(component))?;
    let held = held.as_ref().filter(|_| map.format.is_whole())?;
    Some([held.low[0], held.high[0]])
}
