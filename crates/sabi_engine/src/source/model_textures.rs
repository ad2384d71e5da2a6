//! Textures of a model's materials, and sampling of them.

use std::ops::Range;

use sabi_surface::model::{TextureRef, TextureUvs};

use super::pictures::OpenPicture;
use super::sampler::Sampler;
use super::texels::{SourceSurface, SurfacePoint};

/// Texture of a material.
pub(super) struct Texture<'a> {
    sampler: Sampler,
    /// Transform of the texture coordinates.
    transform: [[f64; 3]; 2],
    /// UV set of the texture; none where it is the set of the atlas.
    pub(super) other: Option<&'a TextureUvs>,
    /// Triangles without that set, in ascending order.
    pub(super) missing: Vec<Range<u32>>,
}

impl<'a> Texture<'a> {
    /// Prepares a texture for an atlas of `size` texels per UV unit.
    pub(super) fn new(
        picture: &OpenPicture,
        texture: &TextureRef,
        other: Option<&'a TextureUvs>,
        is_srgb: bool,
        size: u32,
    ) -> Texture<'a> {
        let transform = texture.transform.map(|row| row.map(f64::from));
        let [u, v] = [0, 1].map(|axis: usize| transform[0][axis].hypot(transform[1][axis]));
        // A texture in the layout of the atlas is never sampled at a level coarser than its texels.
        let least = other.map_or(f64::from(size) / u.max(v).max(1.0), |_| 1.0);
        Texture {
            sampler: Sampler::new(picture.levels(is_srgb, least as u32), texture.wrap),
            transform,
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
}

/// Surface point at which textures are sampled.
#[derive(Clone, Copy)]
pub(super) struct SamplePoint<'a> {
    pub(super) surface: &'a SourceSurface<'a>,
    pub(super) point: &'a SurfacePoint,
}

impl SamplePoint<'_> {
    /// Samples linear RGBA; white without a texture.
    pub(super) fn sample(self, texture: &Option<Texture>) -> [f32; 4] {
        let Some(texture) = texture.as_ref().filter(|texture| texture.covers(self.point.triangle)) else {
            return [1.0; 4];
        };
        let footprint = self.surface.footprint(self.point, texture.other);
        texture.sampler.sample(&footprint.through(&texture.transform))
    }
}
