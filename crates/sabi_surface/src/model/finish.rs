//! Rare properties of a material: a clear coat, anisotropy, a sheen, light below the surface.

use super::TextureRef;

/// A factor, and the texture that it multiplies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TexturedFactor<T> {
    /// The factor, linear.
    pub factor: T,
    /// The texture.
    pub texture: Option<TextureRef>,
}

/// Factors and textures of glTF's material extensions. All factors are zero if a material uses none of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelFinish {
    /// Strength of a clear coat, 0..1; R of the texture (KHR_materials_clearcoat).
    pub coat: TexturedFactor<f32>,
    /// Roughness of the coat; G of the texture.
    pub coat_roughness: TexturedFactor<f32>,
    /// Strength, 0..1; B of the texture, which contains the direction in the tangent frame in R and G (KHR_materials_anisotropy).
    pub anisotropy: TexturedFactor<f32>,
    /// Angle by which the direction is turned, counter-clockwise, radians.
    pub anisotropy_rotation: f32,
    /// Color of the sheen; the texture is sRGB (KHR_materials_sheen).
    pub sheen: TexturedFactor<[f32; 3]>,
    /// Roughness of the sheen; A of the texture.
    pub sheen_roughness: TexturedFactor<f32>,
    /// Share of the light that spreads below the surface; A of the texture (KHR_materials_diffuse_transmission).
    pub subsurface: TexturedFactor<f32>,
    /// Color of that light; the texture is sRGB.
    pub subsurface_color: TexturedFactor<[f32; 3]>,
    /// Share of the light that passes through; R of the texture (KHR_materials_transmission).
    pub transmission: TexturedFactor<f32>,
}

impl ModelFinish {
    /// The textures that it has.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        let all = [
            &self.coat.texture,
            &self.coat_roughness.texture,
            &self.anisotropy.texture,
            &self.sheen.texture,
            &self.sheen_roughness.texture,
            &self.subsurface.texture,
            &self.subsurface_color.texture,
            &self.transmission.texture,
        ];
        all.into_iter().flatten()
    }

    /// The textures that it has, to be changed.
    pub(super) fn textures_mut(&mut self) -> impl Iterator<Item = &mut TextureRef> {
        let all = [
            &mut self.coat.texture,
            &mut self.coat_roughness.texture,
            &mut self.anisotropy.texture,
            &mut self.sheen.texture,
            &mut self.sheen_roughness.texture,
            &mut self.subsurface.texture,
            &mut self.subsurface_color.texture,
            &mut self.transmission.texture,
        ];
        all.into_iter().flatten()
    }
}
