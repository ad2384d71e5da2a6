//! Textures of a model's materials, and their channels in a plane.

use std::ops::Range;

use sabi_surface::model::{TextureRef, TextureUvs, Wrap};

use super::mip_chain::{MipChain, PixelReading};
use super::session_pictures::OpenPicture;

/// Texture of a material.
pub(super) struct ModelTexture<'a> {
    /// Name of the picture, for messages.
    pub(super) name: &'a str,
    pub(super) levels: MipChain,
    pub(super) wrap: [Wrap; 2],
    /// Transform of the texture coordinates, by rows.
    pub(super) transform: [[f32; 3]; 2],
    /// Number of its UV set in the file.
    pub(super) uv_set: u32,
    /// UV set of the texture; `None` if it is the set of the atlas.
    pub(super) other: Option<&'a TextureUvs>,
    /// Triangles without that set, in ascending order.
    pub(super) missing: Vec<Range<u32>>,
}

impl<'a> ModelTexture<'a> {
    /// Prepares a texture for an atlas of `size` texels per UV unit.
    pub(super) fn new(
        name: &'a str,
        picture: &OpenPicture,
        texture: &TextureRef,
        other: Option<&'a TextureUvs>,
        reading: PixelReading,
        size: u32,
    ) -> ModelTexture<'a> {
        let transform = texture.transform.map(|row| row.map(f64::from));
        let [u, v] = [0, 1].map(|axis: usize| transform[0][axis].hypot(transform[1][axis]));
        // A texture in the layout of the atlas is never sampled at a level that is coarser than the atlas's texels.
        let least = other.map_or(f64::from(size) / u.max(v).max(1.0), |_| 1.0);
        ModelTexture {
            name,
            levels: picture.levels(reading, least as u32),
            wrap: texture.wrap,
            transform: texture.transform,
            uv_set: texture.uv_set,
            other,
            missing: Vec::new(),
        }
    }

    /// Returns whether a triangle has coordinates for this texture.
    pub(super) fn covers(&self, triangle: usize) -> bool {
        let after = self.missing.partition_point(|range| range.start as usize <= triangle);
        let last = after.checked_sub(1).and_then(|at| self.missing.get(at));
        last.is_none_or(|range| range.end as usize <= triangle)
    }

    /// Returns true if its coordinates are those of the atlas on all triangles.
    pub(super) fn is_laid_out_by_the_atlas(&self) -> bool {
        self.other.is_none() && self.missing.is_empty()
    }

    /// Returns true if another texture has the same values everywhere, for example if a picture holds several channels.
    fn is_same(&self, other: &ModelTexture<'_>) -> bool {
        self.levels.is_same(&other.levels)
            && (self.wrap, self.transform, self.uv_set) == (other.wrap, other.transform, other.uv_set)
    }
}

/// Channel of a texture; `None` means the value 1.
pub(super) type TextureChannel<'t> = Option<(&'t ModelTexture<'t>, u32)>;

/// Component of a plane: a product of channels and a factor, plus an addend, cut if it has a cutoff.
#[derive(Clone, Copy, Default)]
pub(super) struct Product<'t> {
    pub(super) channels: [TextureChannel<'t>; 2],
    pub(super) factor: f32,
    pub(super) addend: f32,
    /// Value from which the component is 1, and below which it is 0.
    pub(super) cutoff: Option<f32>,
}

impl<'t> Product<'t> {
    /// A number alone.
    pub(super) fn constant(value: f32) -> Product<'t> {
        Product {
            addend: value,
            ..Product::default()
        }
    }

    /// A channel of a texture and a factor.
    pub(super) fn of(texture: &'t Option<ModelTexture<'t>>, channel: u32, factor: f32) -> Product<'t> {
        Product {
            channels: [texture.as_ref().map(|texture| (texture, channel)), None],
            factor,
            ..Product::default()
        }
    }

    /// The product with a channel of one more texture.
    pub(super) fn times(self, texture: &'t Option<ModelTexture<'t>>, channel: u32) -> Product<'t> {
        let second = texture.as_ref().map(|texture| (texture, channel));
        Product {
            channels: [self.channels[0], second],
            ..self
        }
    }
}

/// Returns the textures of some components without repeats, in the order of their first use.
pub(super) fn textures_of<'t>(products: &[Product<'t>]) -> Vec<&'t ModelTexture<'t>> {
    let mut found: Vec<&ModelTexture<'_>> = Vec::new();
    for (texture, _) in products.iter().flat_map(|product| product.channels).flatten() {
        if !found.iter().any(|known| known.is_same(texture)) {
            found.push(texture);
        }
    }
    found
}

/// Number of a channel among four of each texture; none for no channel.
pub(super) fn channel_number(textures: &[&ModelTexture<'_>], channel: TextureChannel<'_>) -> Option<u32> {
    let (texture, channel) = channel?;
    let at = textures.iter().position(|known| known.is_same(texture))?;
    Some(4 * at as u32 + channel)
}
