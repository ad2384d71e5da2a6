//! Channels that few materials of a model have: clear coat, anisotropy, sheen, and scattering below the surface.

use std::collections::BTreeSet;

use sabi_nodes::kind::Channel;
use sabi_surface::model::{Model, ModelFinish, TextureRef};

use super::model_textures::{ModelTexture, Product};

/// Opens a texture, given its purpose and whether it is sRGB.
pub(super) type OpenTexture<'o, 'a> = dyn FnMut(&Option<TextureRef>, &str, bool) -> Option<ModelTexture<'a>> + 'o;

/// Textures of the finish of one material.
pub(super) struct FinishTextures<'a> {
    finish: &'a ModelFinish,
    coat: Option<ModelTexture<'a>>,
    coat_roughness: Option<ModelTexture<'a>>,
    anisotropy: Option<ModelTexture<'a>>,
    sheen: Option<ModelTexture<'a>>,
    sheen_roughness: Option<ModelTexture<'a>>,
    subsurface: Option<ModelTexture<'a>>,
    subsurface_color: Option<ModelTexture<'a>>,
    transmission: Option<ModelTexture<'a>>,
}

/// Returns the channels of the model's materials in addition to the usual ones.
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

    /// Share and roughness of the coat.
    pub(super) fn coat(&self) -> [Product<'_>; 4] {
        let share = Product::of(&self.coat, 0, self.finish.coat.factor);
        let roughness = Product::of(&self.coat_roughness, 1, self.finish.coat_roughness.factor);
        [share, roughness, Product::constant(0.0), Product::constant(1.0)]
    }

    /// Returns the texture for the direction of fine scratches, their strength and their rotation in radians.
    pub(super) fn anisotropy(&self) -> (Option<&ModelTexture<'_>>, f32, f32) {
        let factor = self.finish.anisotropy.factor;
        (self.anisotropy.as_ref(), factor, self.finish.anisotropy_rotation)
    }

    /// Color and roughness of the sheen.
    pub(super) fn sheen(&self) -> [Product<'_>; 4] {
        let [r, g, b] = self.finish.sheen.factor;
        [
            Product::of(&self.sheen, 0, r),
            Product::of(&self.sheen, 1, g),
            Product::of(&self.sheen, 2, b),
            Product::of(&self.sheen_roughness, 3, self.finish.sheen_roughness.factor),
        ]
    }

    /// Light that spreads below the surface, and the share that goes through.
    pub(super) fn subsurface(&self) -> [Product<'_>; 4] {
        let share = self.finish.subsurface.factor;
        let of = |channel: usize| {
            let factor = share * self.finish.subsurface_color.factor[channel];
            Product::of(&self.subsurface, 3, factor).times(&self.subsurface_color, channel as u32)
        };
        let through = Product::of(&self.transmission, 0, self.finish.transmission.factor);
        [of(0), of(1), of(2), through]
    }
}
