//! One map of a copied model, and the channel that it is made of.

use std::sync::Arc;

use sabi_image::{ImageError, PngData, PngOptions, encode_png};

use crate::layout::SetLayout;
use crate::preset::{Component, ComponentSource, MapFormat, NormalY};
use crate::{Channel, ChannelPixels, ConstantValue};

/// A map of a copied model.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFile {
    /// Its file name, or the name it would have.
    pub name: String,
    /// A PNG file.
    pub bytes: Arc<Vec<u8>>,
    /// True if the bake itself writes this very file.
    pub is_written: bool,
}

/// A channel of a set, as it is written.
pub(crate) struct ChannelInput<'a> {
    pub(crate) layout: &'a SetLayout,
    /// Stem of the set's files.
    pub(crate) name: &'a str,
    pub(crate) channel: &'a Channel,
    pub(crate) pixels: &'a ChannelPixels,
    pub(crate) constant: Option<ConstantValue>,
    /// The highest of each component over the owned pixels, 0 without any.
    pub(crate) high: [f32; 3],
    /// Highest value of all components, over all tiles of the material where its tiles share a scale.
    pub(crate) peak: f32,
    /// Seed of the noise of dithered maps.
    pub(crate) dither_seed: u32,
    /// Files that it completed.
    pub(crate) written: &'a [&'a WrittenMap],
}

/// A file of the bake that the copy may use.
#[derive(Clone, Debug)]
pub(crate) struct WrittenMap {
    pub(crate) components: Vec<Component>,
    pub(crate) is_srgb: bool,
    pub(crate) is_dithered: bool,
    pub(crate) format: MapFormat,
    /// True if it has the size of the bake.
    pub(crate) is_whole_size: bool,
    pub(crate) normal_y: NormalY,
    /// Divisor of its values.
    pub(crate) scale: f32,
    pub(crate) file: MapFile,
}

impl ChannelInput<'_> {
    /// The file of the bake with exactly these components, as PNG of 8 bits, and its divisor.
    fn find(&self, sources: &[ComponentSource], is_srgb: bool, is_dithered: bool) -> Option<(&MapFile, f32)> {
        let is_same =
            |component: &Component, source: &ComponentSource| !component.is_inverted && component.source == *source;
        let found = self.written.iter().find(|map| {
            map.format == MapFormat::Png { bits: 8 }
                && (map.is_srgb, map.is_dithered) == (is_srgb, is_dithered)
                && map.is_whole_size
                && map.normal_y == NormalY::Up
                && map.components.len() == sources.len()
                && map
                    .components
                    .iter()
                    .zip(sources)
                    .all(|(held, asked)| is_same(held, asked))
        });
        found.map(|map| (&map.file, map.scale))
    }

    /// The file of the bake with exactly these components, as PNG of 8 bits.
    pub(super) fn written(&self, sources: &[ComponentSource], is_srgb: bool, is_dithered: bool) -> Option<MapFile> {
        let found = self.find(sources, is_srgb, is_dithered);
        found.filter(|(_, scale)| *scale == 1.0).map(|(file, _)| file.clone())
    }

    /// The file of the bake with all components of the channel.
    pub(super) fn written_plain(&self, is_srgb: bool, is_dithered: bool) -> Option<MapFile> {
        self.written(&whole(self.channel), is_srgb, is_dithered)
    }

    /// The file of the bake with a color that was divided by `scale`.
    pub(super) fn written_scaled(&self, scale: f32) -> Option<MapFile> {
        let found = self.find(&whole(self.channel), true, false);
        found.filter(|(_, by)| *by == scale).map(|(file, _)| file.clone())
    }
}

/// All components of a channel.
pub(super) fn whole(channel: &Channel) -> Vec<ComponentSource> {
    let component = |at| ComponentSource::Channel(channel.clone(), at);
    (0..channel.components()).map(component).collect()
}

/// 8-bit codes of a channel, or its constant value.
#[derive(Debug)]
pub(super) enum CodedChannel {
    Codes(Vec<u8>),
    Constant(ConstantValue),
}

impl CodedChannel {
    pub(super) fn number(&self) -> Option<f32> {
        match self {
            CodedChannel::Constant(ConstantValue::Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// The code of a pixel.
    pub(super) fn code(&self, pixel: usize) -> u8 {
        match self {
            CodedChannel::Codes(codes) => codes[pixel],
            CodedChannel::Constant(ConstantValue::Number(value)) => sabi_image::quantize_u8(*value),
            CodedChannel::Constant(ConstantValue::Triple(_)) => 0,
        }
    }
}

pub(super) fn own_map(input: &ChannelInput<'_>, what: &str, bytes: Vec<u8>) -> MapFile {
    let tile = input
        .layout
        .key
        .udim
        .map_or_else(String::new, |udim| format!(".{udim}"));
    MapFile {
        name: format!("{}_{what}{tile}.png", input.name),
        bytes: Arc::new(bytes),
        is_written: false,
    }
}

pub(super) fn png(size: u32, channels: u8, codes: &[u8], srgb_chunk: bool) -> Result<Vec<u8>, ImageError> {
    let options = PngOptions {
        channels,
        bits: 8,
        srgb_chunk,
    };
    encode_png(size, size, PngData::U8(codes), options)
}
