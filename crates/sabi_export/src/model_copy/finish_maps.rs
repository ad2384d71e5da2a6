//! Coat, anisotropy, sheen and subsurface light in the form of glTF's material extensions.

use sabi_image::ImageError;

use super::map_file::{ChannelInput, CodedChannel, MapFile, own_map, png};
use crate::preset::ComponentSource;
use crate::{Channel, ConstantValue};

/// A factor, and the map that it multiplies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MappedFactor<T> {
    /// The value without a map, 1 with one.
    pub factor: T,
    /// The map where the value varies.
    pub map: Option<MapFile>,
}

/// Factors and maps of rare material properties; zero for properties that a material does not have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FinishMaps {
    /// Share below a clear coat, in R.
    pub coat: MappedFactor<f32>,
    /// Roughness of the coat, in G of the same map.
    pub coat_roughness: f32,
    /// Strength of anisotropy; with a map in B, beside the direction in R and G.
    pub anisotropy: MappedFactor<f32>,
    /// Angle of the direction from the tangent, radians, without a map.
    pub anisotropy_rotation: f32,
    /// Linear color of the sheen, sRGB in RGB of the map.
    pub sheen: MappedFactor<[f32; 3]>,
    /// Roughness of the sheen, in A of the same map.
    pub sheen_roughness: f32,
    /// Linear color of the light that spreads below the surface; the map is sRGB.
    pub subsurface: MappedFactor<[f32; 3]>,
    /// Share of the light that goes through, in R.
    pub transmission: MappedFactor<f32>,
}

/// Channels of a set that share a map with the next one.
#[derive(Debug, Default)]
pub(super) struct FinishCollector {
    /// The first of two channels that are packed together.
    first: Option<CodedChannel>,
}

impl FinishCollector {
    /// Adds one of the channels that few materials have.
    pub(super) fn take(
        &mut self,
        input: &ChannelInput<'_>,
        coded: CodedChannel,
        maps: &mut FinishMaps,
    ) -> Result<(), ImageError> {
        match input.channel {
            Channel::Coat | Channel::Sheen => self.first = Some(coded),
            Channel::CoatRoughness => {
                let Some(coat) = self.first.take() else { return Ok(()) };
                let constants = coat.number().zip(coded.number());
                let codes = |pixel: usize| [coat.code(pixel), coded.code(pixel), 0];
                (maps.coat, maps.coat_roughness) = match constants {
                    Some((factor, roughness)) => (MappedFactor { factor, map: None }, roughness),
                    None => {
                        let sources = [
                            of(Channel::Coat, 0),
                            of(Channel::CoatRoughness, 0),
                            ComponentSource::Constant(0.0),
                        ];
                        let map = match input.written(&sources, false, true) {
                            Some(file) => file,
                            None => packed(input, "coat_packed", codes)?,
                        };
                        (with_map(1.0, map), 1.0)
                    }
                };
            }
            Channel::SheenRoughness => {
                let Some(sheen) = self.first.take() else { return Ok(()) };
                (maps.sheen, maps.sheen_roughness) = match (sheen.triple(), coded.number()) {
                    (Some(factor), Some(roughness)) => (MappedFactor { factor, map: None }, roughness),
                    _ => {
                        let codes = |pixel: usize| {
                            let [r, g, b] = sheen.triple_code(pixel);
                            [r, g, b, coded.code(pixel)]
                        };
                        let mut sources: Vec<ComponentSource> = (0..3).map(|at| of(Channel::Sheen, at)).collect();
                        sources.push(of(Channel::SheenRoughness, 0));
                        let map = match input.written(&sources, true, false) {
                            Some(file) => file,
                            None => packed(input, "sheen_packed", codes)?,
                        };
                        (with_map([1.0; 3], map), 1.0)
                    }
                };
            }
            Channel::Anisotropy => match coded.triple() {
                Some([x, y, strength]) => {
                    maps.anisotropy.factor = strength;
                    maps.anisotropy_rotation = (2.0 * y - 1.0).atan2(2.0 * x - 1.0);
                }
                None => maps.anisotropy = with_map(1.0, plain(input, &coded, "anisotropy_8bit")?),
            },
            Channel::Subsurface => {
                maps.subsurface = match coded.triple() {
                    Some(factor) => MappedFactor { factor, map: None },
                    None => with_map([1.0; 3], plain(input, &coded, "subsurface_8bit")?),
                }
            }
            Channel::Transmission => {
                maps.transmission = match coded.number() {
                    Some(factor) => MappedFactor { factor, map: None },
                    // Red of a gray picture is its gray.
                    None => with_map(
                        1.0,
                        match input.written_plain(false, true) {
                            Some(file) => file,
                            None => packed(input, "transmission_packed", |pixel| [coded.code(pixel), 0, 0])?,
                        },
                    ),
                }
            }
            _ => {}
        }
        Ok(())
    }
}

fn of(channel: Channel, component: usize) -> ComponentSource {
    ComponentSource::Channel(channel, component)
}

fn with_map<T>(factor: T, map: MapFile) -> MappedFactor<T> {
    MappedFactor { factor, map: Some(map) }
}

/// A map of the codes of each pixel.
fn packed<const N: usize>(
    input: &ChannelInput<'_>,
    what: &str,
    codes: impl Fn(usize) -> [u8; N],
) -> Result<MapFile, ImageError> {
    let codes: Vec<u8> = (0..input.layout.cover.len()).flat_map(codes).collect();
    let is_color = matches!(input.channel, Channel::SheenRoughness);
    Ok(own_map(input, what, png(input.layout.size, N as u8, &codes, is_color)?))
}

/// The file that the bake wrote for a channel of three numbers, or one of its codes.
fn plain(input: &ChannelInput<'_>, coded: &CodedChannel, what: &str) -> Result<MapFile, ImageError> {
    match input.written_plain(input.channel.is_color(), false) {
        Some(file) => Ok(file),
        None => packed(input, what, |pixel| coded.triple_code(pixel)),
    }
}

impl CodedChannel {
    fn triple(&self) -> Option<[f32; 3]> {
        match self {
            CodedChannel::Constant(ConstantValue::Triple(values)) => Some(*values),
            _ => None,
        }
    }

    fn triple_code(&self, pixel: usize) -> [u8; 3] {
        match self {
            CodedChannel::Codes(codes) => std::array::from_fn(|at| codes[3 * pixel + at]),
            CodedChannel::Constant(ConstantValue::Triple(values)) => values.map(sabi_color::srgb8_from_linear),
            CodedChannel::Constant(ConstantValue::Number(_)) => [0; 3],
        }
    }
}
