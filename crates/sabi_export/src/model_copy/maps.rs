//! The maps of a material as glTF packs them, gathered while the channels of a set go by.

use std::collections::BTreeMap;
use std::sync::Arc;

use sabi_image::{ImageError, PngData, PngOptions, encode_png};

use crate::encode::{codes_8, encode};
use crate::layout::SetLayout;
use crate::preset::{Codes, Format};
use crate::{Channel, ChannelPixels, Value};

/// A map of a copied model.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFile {
    /// Its file name, or the name it would have.
    pub name: String,
    /// A PNG file.
    pub bytes: Arc<Vec<u8>>,
    /// Whether the bake writes this very file anyway.
    pub is_written: bool,
}

/// Factors and maps of a glTF material. A constant channel is a factor; occlusion, which has none, is left out where it is
/// 1.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialMaps {
    /// Linear RGBA; white, and opaque, where the map has them.
    pub base_color_factor: [f32; 4],
    /// sRGB, with opacity in alpha where that varies.
    pub base_color: Option<MapFile>,
    /// Whether anything is not opaque.
    pub has_opacity: bool,
    /// 1 where the map has it.
    pub roughness_factor: f32,
    /// 1 where the map has it.
    pub metallic_factor: f32,
    /// Occlusion in R, roughness in G, metallic in B.
    pub packed: Option<MapFile>,
    /// Whether the packed map gives roughness and metallic.
    pub packed_surface: bool,
    /// Whether the packed map gives occlusion.
    pub packed_occlusion: bool,
    /// Tangent-space normals, Y+, 8 bit.
    pub normal: Option<MapFile>,
    /// Linear RGB up to 1; white where the map has it.
    pub emission_factor: [f32; 3],
    /// Multiplier of emission: 1 unless emission exceeds 1.
    pub emission_strength: f32,
    /// sRGB, as a part of the strength.
    pub emission: Option<MapFile>,
}

impl Default for MaterialMaps {
    fn default() -> Self {
        MaterialMaps {
            base_color_factor: [1.0; 4],
            base_color: None,
            has_opacity: false,
            roughness_factor: 1.0,
            metallic_factor: 1.0,
            packed: None,
            packed_surface: false,
            packed_occlusion: false,
            normal: None,
            emission_factor: [0.0; 3],
            emission_strength: 1.0,
            emission: None,
        }
    }
}

/// A channel as it goes by.
pub(crate) struct Passing<'a> {
    pub(crate) layout: &'a SetLayout,
    /// Stem of the set's files.
    pub(crate) name: &'a str,
    pub(crate) channel: &'a Channel,
    pub(crate) pixels: &'a ChannelPixels,
    pub(crate) constant: Option<Value>,
    /// The highest of each component over the owned pixels, 0 without any.
    pub(crate) high: [f32; 3],
    /// The files that it became.
    pub(crate) written: &'a [(Format, MapFile)],
}

/// 8-bit codes of a channel, or the one value that it has.
#[derive(Debug)]
enum Held {
    Codes(Vec<u8>),
    Constant(Value),
}

impl Held {
    fn number(&self) -> Option<f32> {
        match self {
            Held::Constant(Value::Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// The code of a pixel.
    fn code(&self, pixel: usize) -> u8 {
        match self {
            Held::Codes(codes) => codes[pixel],
            Held::Constant(Value::Number(value)) => sabi_image::quantize_u8(*value),
            Held::Constant(Value::Triple(_)) => 0,
        }
    }
}

/// Maps on their way into materials. A set's base color is held until its opacity comes, and roughness and metallic
/// until occlusion does.
#[derive(Debug, Default)]
pub(crate) struct Gathering {
    done: BTreeMap<u32, MaterialMaps>,
    color: Option<(Held, Option<MapFile>)>,
    surface: Vec<Held>,
}

const PLAIN_COLOR: Format = Format::Png {
    bits: 8,
    codes: Codes::Srgb,
    dither: false,
};

impl Gathering {
    /// Takes what of a channel a glTF material can use. Channels of a set come in the order of [`Channel::ALL`].
    pub(crate) fn take(&mut self, passing: &Passing<'_>) -> Result<(), ImageError> {
        let size = passing.layout.size;
        let same = |format: Format| {
            let of_format = passing.written.iter().find(|(written, _)| *written == format);
            of_format.map(|(_, file)| file.clone())
        };
        let held = |codes, dither| match passing.constant {
            Some(value) => Held::Constant(value),
            None => Held::Codes(codes_8(passing.pixels, size, codes, dither, [0.0, 1.0])),
        };
        match passing.channel {
            Channel::BaseColor => self.color = Some((held(Codes::Srgb, false), same(PLAIN_COLOR))),
            Channel::Opacity => self.color_and_opacity(passing, &held(Codes::Unit, false))?,
            Channel::Roughness => self.surface = vec![held(Codes::Unit, true)],
            Channel::Metallic => self.surface.push(held(Codes::Unit, true)),
            Channel::Occlusion => {
                self.surface.push(held(Codes::Unit, true));
                self.packed(passing)?;
            }
            Channel::Normal if passing.constant.is_none() => {
                let format = Format::Png {
                    bits: 8,
                    codes: Codes::Signed,
                    dither: false,
                };
                let file = own_map(
                    passing,
                    "normal_8bit",
                    encode(passing.pixels, size, format, [0.0; 2])?.bytes,
                );
                self.of(passing).normal = Some(file);
            }
            Channel::Emission => self.emission(passing, same(PLAIN_COLOR))?,
            Channel::Normal | Channel::Height | Channel::Mask(_) => {}
        }
        Ok(())
    }

    /// Returns the collected maps by material.
    pub(crate) fn finish(self) -> BTreeMap<u32, MaterialMaps> {
        self.done
    }

    fn of(&mut self, passing: &Passing<'_>) -> &mut MaterialMaps {
        self.done.entry(passing.layout.key.material).or_default()
    }

    fn color_and_opacity(&mut self, passing: &Passing<'_>, opacity: &Held) -> Result<(), ImageError> {
        let Some((color, written)) = self.color.take() else {
            return Ok(());
        };
        let alpha = opacity.number();
        // A varying opacity is in the map, and its factor is 1.
        let mut factor = [1.0, 1.0, 1.0, alpha.unwrap_or(1.0)];
        let file = match (&color, alpha) {
            (Held::Constant(Value::Triple(rgb)), Some(_)) => {
                factor[..3].copy_from_slice(rgb);
                None
            }
            (Held::Constant(value), None) => {
                // The map is white, and the color stays exact.
                if let Value::Triple(rgb) = value {
                    factor[..3].copy_from_slice(rgb);
                }
                Some(rgba(passing, |_| [255; 3], opacity)?)
            }
            (Held::Codes(codes), None) => Some(rgba(
                passing,
                |pixel| std::array::from_fn(|at| codes[3 * pixel + at]),
                opacity,
            )?),
            (Held::Codes(codes), Some(_)) => Some(match written {
                Some(file) => file,
                None => own_map(passing, "base_color", png(passing.layout.size, 3, codes, true)?),
            }),
            (Held::Constant(Value::Number(_)), Some(_)) => None,
        };
        let maps = self.of(passing);
        maps.base_color_factor = factor.map(|value| value.clamp(0.0, 1.0));
        maps.base_color = file;
        maps.has_opacity = alpha.is_none_or(|alpha| alpha < 1.0);
        Ok(())
    }

    fn packed(&mut self, passing: &Passing<'_>) -> Result<(), ImageError> {
        let surface = std::mem::take(&mut self.surface);
        let [roughness, metallic, occlusion] = &surface[..] else {
            return Ok(());
        };
        let open = occlusion.number().is_some_and(|open| open >= 1.0);
        let factors = roughness.number().zip(metallic.number());
        let mut packed = None;
        if factors.is_none() || !open {
            let pixels = passing.layout.cover.len();
            let codes: Vec<u8> = (0..pixels)
                .flat_map(|pixel| [occlusion, roughness, metallic].map(|held| held.code(pixel)))
                .collect();
            let bytes = png(passing.layout.size, 3, &codes, false)?;
            packed = Some(own_map(passing, "occlusion_roughness_metallic", bytes));
        }
        let maps = self.of(passing);
        // A program that reads maps and no factors should see the right thing too, so factors beside maps are 1.
        [maps.roughness_factor, maps.metallic_factor] = factors.map_or([1.0; 2], |(roughness, metallic)| {
            [roughness, metallic].map(|x| x.clamp(0.0, 1.0))
        });
        maps.packed = packed;
        maps.packed_surface = factors.is_none();
        maps.packed_occlusion = !open;
        Ok(())
    }

    fn emission(&mut self, passing: &Passing<'_>, written: Option<MapFile>) -> Result<(), ImageError> {
        let high = passing.high;
        let strength = high.into_iter().fold(1.0, f32::max);
        let (factor, file) = match (passing.constant, written) {
            (Some(Value::Triple(rgb)), _) => (rgb.map(|value| value.max(0.0) / strength), None),
            (Some(Value::Number(_)), _) => ([0.0; 3], None),
            (None, Some(file)) if strength == 1.0 => ([1.0; 3], Some(file)),
            (None, _) => {
                let part = ChannelPixels {
                    components: 3,
                    data: passing.pixels.data.iter().map(|value| value / strength).collect(),
                };
                let bytes = encode(&part, passing.layout.size, PLAIN_COLOR, [0.0; 2])?.bytes;
                ([1.0; 3], Some(own_map(passing, "emission_up_to_1", bytes)))
            }
        };
        let maps = self.of(passing);
        (maps.emission_factor, maps.emission_strength, maps.emission) = (factor, strength, file);
        Ok(())
    }
}

fn own_map(passing: &Passing<'_>, what: &str, bytes: Vec<u8>) -> MapFile {
    MapFile {
        name: format!("{}_{what}.png", passing.name),
        bytes: Arc::new(bytes),
        is_written: false,
    }
}

fn rgba(passing: &Passing<'_>, color: impl Fn(usize) -> [u8; 3], opacity: &Held) -> Result<MapFile, ImageError> {
    let pixels = passing.layout.cover.len();
    let codes: Vec<u8> = (0..pixels)
        .flat_map(|pixel| {
            let [r, g, b] = color(pixel);
            [r, g, b, opacity.code(pixel)]
        })
        .collect();
    let bytes = png(passing.layout.size, 4, &codes, true)?;
    Ok(own_map(passing, "base_color_opacity", bytes))
}

fn png(size: u32, channels: u8, codes: &[u8], srgb_chunk: bool) -> Result<Vec<u8>, ImageError> {
    let options = PngOptions {
        channels,
        bits: 8,
        srgb_chunk,
    };
    encode_png(size, size, PngData::U8(codes), options)
}
