//! The maps of a set as glTF packs them, collected while the channels of a set are written.

use std::collections::BTreeMap;

use sabi_image::ImageError;

use super::finish_maps::{FinishCollector, FinishMaps};
use super::map_file::{ChannelInput, CodedChannel, MapFile, own_map, png, whole};
use crate::encode::{CodeMapping, ComponentPlane, FileEncoding, codes_8, encode, planes};
use crate::preset::{ComponentSource, MapFormat};
use crate::{Channel, ChannelPixels, ConstantValue, SetKey};

/// Factors and maps of a glTF material. A constant channel becomes a factor. Occlusion has no factor and is omitted if it is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialMaps {
    /// Linear RGBA; white, and opaque, where the map has them.
    pub base_color_factor: [f32; 4],
    /// sRGB, with opacity in alpha where that varies.
    pub base_color: Option<MapFile>,
    /// True if any pixel is not opaque.
    pub has_opacity: bool,
    /// 1 where the map has it.
    pub roughness_factor: f32,
    /// 1 where the map has it.
    pub metallic_factor: f32,
    /// Occlusion in R, roughness in G, metallic in B.
    pub packed: Option<MapFile>,
    /// True if the packed map contains roughness and metallic.
    pub packed_surface: bool,
    /// True if the packed map contains occlusion.
    pub packed_occlusion: bool,
    /// Tangent-space normals, Y+, 8 bit.
    pub normal: Option<MapFile>,
    /// Linear RGB up to 1; white where the map has it.
    pub emission_factor: [f32; 3],
    /// Multiplier of emission: 1 unless emission exceeds 1.
    pub emission_strength: f32,
    /// sRGB, as a part of the strength.
    pub emission: Option<MapFile>,
    /// Rare properties.
    pub finish: FinishMaps,
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
            finish: FinishMaps::default(),
        }
    }
}

/// Collected maps of sets. Base color is kept until opacity is written, and roughness and metallic until occlusion is,
/// since glTF packs them into one map.
#[derive(Debug, Default)]
pub(crate) struct MapCollector {
    done: BTreeMap<SetKey, MaterialMaps>,
    color: Option<(CodedChannel, Option<MapFile>)>,
    surface: Vec<CodedChannel>,
    finish: FinishCollector,
}

/// Maps of 8 bits at the size of a set.
fn eight_bits(input: &ChannelInput<'_>, is_srgb: bool) -> FileEncoding {
    FileEncoding {
        size: [input.layout.size; 2],
        format: MapFormat::Png { bits: 8 },
        is_srgb,
    }
}

/// 8-bit codes of a channel.
fn channel_codes(input: &ChannelInput<'_>, is_srgb: bool, is_dithered: bool) -> Vec<u8> {
    let mut planes = planes(input.pixels, CodeMapping::Unit);
    for plane in planes.iter_mut().filter(|_| is_dithered) {
        if let ComponentPlane::Channel { index, dither, .. } = plane {
            *dither = Some(input.channel.dither_pattern(*index, input.dither_seed));
        }
    }
    codes_8(&planes, eight_bits(input, is_srgb))
}

impl MapCollector {
    /// Adds a channel, as far as a glTF material can use it. Channels of a set come in the order of [`Channel::ALL`].
    pub(crate) fn take(&mut self, input: &ChannelInput<'_>) -> Result<(), ImageError> {
        let held = |is_srgb, is_dithered| match input.constant {
            Some(value) => CodedChannel::Constant(value),
            None => CodedChannel::Codes(channel_codes(input, is_srgb, is_dithered)),
        };
        match input.channel {
            Channel::BaseColor => self.color = Some((held(true, false), input.written_plain(true, false))),
            Channel::Opacity => self.color_and_opacity(input, &held(false, false))?,
            Channel::Roughness => self.surface = vec![held(false, true)],
            Channel::Metallic => self.surface.push(held(false, true)),
            Channel::Occlusion => {
                self.surface.push(held(false, true));
                self.packed(input)?;
            }
            Channel::Normal if input.constant.is_none() => {
                let file = match input.written_plain(false, false) {
                    Some(file) => file,
                    None => {
                        let planes = planes(input.pixels, CodeMapping::Normal { is_down: false });
                        own_map(input, "normal_8bit", encode(&planes, eight_bits(input, false))?)
                    }
                };
                self.of(input).normal = Some(file);
            }
            Channel::Emission => self.emission(input)?,
            Channel::Normal | Channel::Height | Channel::Mesh(_) => {}
            output if output.output_kind().is_some() => {}
            rare => {
                let is_dithered = !rare.is_color() && *rare != Channel::Anisotropy;
                let coded = held(rare.is_color(), is_dithered);
                let finish = &mut self.done.entry(input.layout.key).or_default().finish;
                self.finish.take(input, coded, finish)?;
            }
        }
        Ok(())
    }

    /// Returns the collected maps.
    pub(crate) fn finish(self) -> BTreeMap<SetKey, MaterialMaps> {
        self.done
    }

    fn of(&mut self, input: &ChannelInput<'_>) -> &mut MaterialMaps {
        self.done.entry(input.layout.key).or_default()
    }

    fn color_and_opacity(&mut self, input: &ChannelInput<'_>, opacity: &CodedChannel) -> Result<(), ImageError> {
        let Some((color, written)) = self.color.take() else {
            return Ok(());
        };
        let alpha = opacity.number();
        // A file with both, such as that of the preset for glTF, is completed by opacity.
        let mut both = whole(&Channel::BaseColor);
        both.extend(whole(&Channel::Opacity));
        let with_opacity = || input.written(&both, true, false);
        // Without the opacity, where that is 1: the file is whole only now.
        let written = written.or_else(|| input.written(&whole(&Channel::BaseColor), true, false));
        // If opacity varies, it is in the map, and its factor is 1.
        let mut factor = [1.0, 1.0, 1.0, alpha.unwrap_or(1.0)];
        let file = match (&color, alpha) {
            (CodedChannel::Constant(ConstantValue::Triple(rgb)), Some(_)) => {
                factor[..3].copy_from_slice(rgb);
                None
            }
            (CodedChannel::Constant(value), None) => {
                // The map is white, so that the factor gives the exact color.
                if let ConstantValue::Triple(rgb) = value {
                    factor[..3].copy_from_slice(rgb);
                }
                Some(rgba(input, |_| [255; 3], opacity)?)
            }
            (CodedChannel::Codes(codes), None) => Some(match with_opacity() {
                Some(file) => file,
                None => rgba(input, |pixel| std::array::from_fn(|at| codes[3 * pixel + at]), opacity)?,
            }),
            (CodedChannel::Codes(codes), Some(_)) => Some(match (written, with_opacity()) {
                (Some(file), _) => file,
                (None, Some(file)) => {
                    factor[3] = 1.0;
                    file
                }
                (None, None) => own_map(input, "base_color", png(input.layout.size, 3, codes, true)?),
            }),
            (CodedChannel::Constant(ConstantValue::Number(_)), Some(_)) => None,
        };
        let maps = self.of(input);
        maps.base_color_factor = factor.map(|value| value.clamp(0.0, 1.0));
        maps.base_color = file;
        maps.has_opacity = alpha.is_none_or(|alpha| alpha < 1.0);
        Ok(())
    }

    fn packed(&mut self, input: &ChannelInput<'_>) -> Result<(), ImageError> {
        let surface = std::mem::take(&mut self.surface);
        let [roughness, metallic, occlusion] = &surface[..] else {
            return Ok(());
        };
        let open = occlusion.number().is_some_and(|open| open >= 1.0);
        let factors = roughness.number().zip(metallic.number());
        let mut packed = None;
        if factors.is_none() || !open {
            let pixels = input.layout.cover.len();
            let codes: Vec<u8> = (0..pixels)
                .flat_map(|pixel| [occlusion, roughness, metallic].map(|held| held.code(pixel)))
                .collect();
            let sources = [Channel::Occlusion, Channel::Roughness, Channel::Metallic]
                .map(|channel| ComponentSource::Channel(channel, 0));
            packed = Some(match input.written(&sources, false, true) {
                Some(file) => file,
                None => {
                    let bytes = png(input.layout.size, 3, &codes, false)?;
                    own_map(input, "occlusion_roughness_metallic", bytes)
                }
            });
        }
        let maps = self.of(input);
        // Some programs read maps and ignore factors, so factors are 1 where there are maps.
        [maps.roughness_factor, maps.metallic_factor] = factors.map_or([1.0; 2], |(roughness, metallic)| {
            [roughness, metallic].map(|x| x.clamp(0.0, 1.0))
        });
        maps.packed = packed;
        maps.packed_surface = factors.is_none();
        maps.packed_occlusion = !open;
        Ok(())
    }

    fn emission(&mut self, input: &ChannelInput<'_>) -> Result<(), ImageError> {
        let highest = input.high.into_iter().fold(1.0, f32::max);
        let strength = match input.constant {
            Some(_) => highest,
            None => input.peak.max(1.0),
        };
        let (factor, file) = match (input.constant, input.written_scaled(strength)) {
            (Some(ConstantValue::Triple(rgb)), _) => (rgb.map(|value| value.max(0.0) / strength), None),
            (Some(ConstantValue::Number(_)), _) => ([0.0; 3], None),
            (None, Some(file)) => ([1.0; 3], Some(file)),
            (None, None) => {
                let part = ChannelPixels {
                    components: 3,
                    data: input.pixels.data.iter().map(|value| value / strength).collect(),
                };
                let bytes = encode(&planes(&part, CodeMapping::Unit), eight_bits(input, true))?;
                ([1.0; 3], Some(own_map(input, "emission_up_to_1", bytes)))
            }
        };
        let maps = self.of(input);
        (maps.emission_factor, maps.emission_strength, maps.emission) = (factor, strength, file);
        Ok(())
    }
}

fn rgba(
    input: &ChannelInput<'_>,
    color: impl Fn(usize) -> [u8; 3],
    opacity: &CodedChannel,
) -> Result<MapFile, ImageError> {
    let pixels = input.layout.cover.len();
    let codes: Vec<u8> = (0..pixels)
        .flat_map(|pixel| {
            let [r, g, b] = color(pixel);
            [r, g, b, opacity.code(pixel)]
        })
        .collect();
    let bytes = png(input.layout.size, 4, &codes, true)?;
    Ok(own_map(input, "base_color_opacity", bytes))
}
