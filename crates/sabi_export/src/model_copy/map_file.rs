//! One map of a copied model, and the channel that it is made of.

use std::sync::Arc;

use sabi_image::{ImageError, PngData, PngOptions, encode_png};

use crate::layout::SetLayout;
use crate::preset::Format;
use crate::{Channel, ChannelPixels, Value};

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
    pub(crate) constant: Option<Value>,
    /// The highest of each component over the owned pixels, 0 without any.
    pub(crate) high: [f32; 3],
    /// Its files.
    pub(crate) written: &'a [(Format, MapFile)],
}

/// 8-bit codes of a channel, or its constant value.
#[derive(Debug)]
pub(super) enum CodedChannel {
    Codes(Vec<u8>),
    Constant(Value),
}

impl CodedChannel {
    pub(super) fn number(&self) -> Option<f32> {
        match self {
            CodedChannel::Constant(Value::Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// The code of a pixel.
    pub(super) fn code(&self, pixel: usize) -> u8 {
        match self {
            CodedChannel::Codes(codes) => codes[pixel],
            CodedChannel::Constant(Value::Number(value)) => sabi_image::quantize_u8(*value),
            CodedChannel::Constant(Value::Triple(_)) => 0,
        }
    }
}

pub(super) fn own_map(input: &ChannelInput<'_>, what: &str, bytes: Vec<u8>) -> MapFile {
    MapFile {
        name: format!("{}_{what}.png", input.name),
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
