//! What few materials of a model have, sampled: clear coat, anisotropy, sheen, light below the surface.

use std::collections::BTreeSet;

use sabi_nodes::kind::Channel;
use sabi_surface::model::{Model, ModelFinish, Scaled, TextureRef};

use super::model_textures::{SamplePoint, Texture};

/// Opens a texture, told what it shows, and whether it is sRGB.
pub(super) type OpenTexture<'o, 'a> = dyn FnMut(&Option<TextureRef>, &str, bool) -> Option<Texture<'a>> + 'o;

/// Textures of the finish of one material.
pub(super) struct FinishTextures<'a> {
    finish: &'a ModelFinish,
    coat: Option<Texture<'a>>,
    coat_roughness: Option<Texture<'a>>,
    anisotropy: Option<Texture<'a>>,
    sheen: Option<Texture<'a>>,
    sheen_roughness: Option<Texture<'a>>,
    subsurface: Option<Texture<'a>>,
    subsurface_color: Option<Texture<'a>>,
    transmission: Option<Texture<'a>>,
}

/// Channels that the materials of a model have besides the usual ones.
pub(super) fn channels(model: &Model) -> BTreeSet<Channel> {
    let finishes = model.materials.iter().map(|material| &material.finish);
    let of = |finish: &ModelFinish| {
        let sheens = finish.sheen.factor.iter().any(|part| *part > 0.0);
        let spreads = finish.subsurface.factor > 0.0 || finish.transmission.factor > 0.0;
        let has = [
            (finish.coat.factor > 0.0, Channel::Coat),
            (finish.anisotropy.factor > 0.0, Channel::Anisotropy),
            (sheens, Channel::Sheen),
            (spreads, Channel::Subsurface),
        ];
        has.into_iter().filter_map(|(has, channel)| has.then_some(channel))
    };
    finishes.flat_map(of).collect()
}

impl<'a> FinishTextures<'a> {
    /// Opens the textures.
    pub(super) fn new(finish: &'a ModelFinish, open: &mut OpenTexture<'_, 'a>) -> FinishTextures<'a> {
        FinishTextures {
            finish,
            coat: open(&finish.coat.texture, "clear coat", false),
            coat_roughness: open(&finish.coat_roughness.texture, "clear coat's roughness", false),
            anisotropy: open(&finish.anisotropy.texture, "anisotropy", false),
            sheen: open(&finish.sheen.texture, "sheen", true),
            sheen_roughness: open(&finish.sheen_roughness.texture, "sheen's roughness", false),
            subsurface: open(&finish.subsurface.texture, "diffuse transmission", false),
            subsurface_color: open(&finish.subsurface_color.texture, "diffuse transmission's color", true),
            transmission: open(&finish.transmission.texture, "transmission", false),
        }
    }

    /// Samples the share and the roughness of the coat.
    pub(super) fn coat(&self, at: SamplePoint) -> [f32; 4] {
        let share = one(&self.finish.coat, at.sample(&self.coat)[0]);
        let roughness = one(&self.finish.coat_roughness, at.sample(&self.coat_roughness)[1]);
        [share, roughness, 0.0, 1.0]
    }

    /// Samples the direction of fine scratches in model space, as long as they are strong. glTF has the direction across them.
    pub(super) fn anisotropy(&self, at: SamplePoint) -> [f32; 4] {
        let texture = self
            .anisotropy
            .as_ref()
            .filter(|texture| texture.covers(at.point.triangle));
        let [x, y, strength] = match texture {
            Some(_) => {
                let [r, g, b, _] = at.sample(&self.anisotropy);
                [2.0 * r - 1.0, 2.0 * g - 1.0, b]
            }
            None => [1.0, 0.0, 1.0],
        };
        let (sin, cos) = self.finish.anisotropy_rotation.sin_cos();
        let [x, y] = [cos * x - sin * y, sin * x + cos * y].map(f64::from);
        let frame = at.surface.frame_of(at.point, texture.and_then(|texture| texture.other));
        let across = x * frame.tangent.normalize_or_zero() + y * frame.bitangent.normalize_or_zero();
        let along = across.cross(frame.normal).normalize_or_zero();
        let [x, y, z] = (along * f64::from(self.finish.anisotropy.factor * strength))
            .as_vec3()
            .to_array();
        [x, y, z, 1.0]
    }

    /// Samples the color and the roughness of the sheen.
    pub(super) fn sheen(&self, at: SamplePoint) -> [f32; 4] {
        let [r, g, b] = three(&self.finish.sheen, at.sample(&self.sheen));
        let roughness = one(&self.finish.sheen_roughness, at.sample(&self.sheen_roughness)[3]);
        [r, g, b, roughness]
    }

    /// Samples the light that spreads below the surface, and the share that goes through.
    pub(super) fn subsurface(&self, at: SamplePoint) -> [f32; 4] {
        let share = one(&self.finish.subsurface, at.sample(&self.subsurface)[3]);
        let color = three(&self.finish.subsurface_color, at.sample(&self.subsurface_color));
        let [r, g, b] = color.map(|part| share * part);
        [
            r,
            g,
            b,
            one(&self.finish.transmission, at.sample(&self.transmission)[0]),
        ]
    }
}

fn one(scaled: &Scaled<f32>, sampled: f32) -> f32 {
    scaled.factor * sampled
}

fn three(scaled: &Scaled<[f32; 3]>, sampled: [f32; 4]) -> [f32; 3] {
    std::array::from_fn(|at| scaled.factor[at] * sampled[at])
}
