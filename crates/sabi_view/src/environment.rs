//! Environment light on the device: prefiltered reflections, irradiance and the background.

mod backdrop;
mod cube_bytes;
mod irradiance;
mod panorama;
pub(crate) mod prefilter;

use glam::{DVec3, Vec3, Vec4};
use sabi_gpu::Gpu;

use crate::error::ViewError;
pub use panorama::Panorama;

/// An environment on the device. For the axes see [`Panorama`].
pub struct Environment {
    specular: wgpu::Texture,
    backdrop: wgpu::Texture,
    irradiance: [[f32; 4]; 9],
}

impl Environment {
    /// Prefilters a panorama, and waits until the device is done.
    pub fn new(gpu: &Gpu, panorama: &Panorama) -> Result<Environment, ViewError> {
        let levels = backdrop::levels(panorama);
        let backdrop = backdrop::upload(gpu, &levels)?;
        let specular = prefilter::prefilter(gpu, &backdrop, prefilter::face_side(panorama))?;
        Ok(Environment {
            specular,
            backdrop,
            irradiance: rows(&irradiance::irradiance(&levels[0])),
        })
    }

    /// Creates an environment like [`Environment::new`], with reflections that [`Environment::prefiltered_bytes`] returned
    /// for the same panorama.
    pub fn from_prefiltered(gpu: &Gpu, panorama: &Panorama, prefiltered: &[u8]) -> Result<Environment, ViewError> {
        let specular = cube_bytes::upload(gpu, prefilter::face_side(panorama), prefiltered)?;
        let levels = backdrop::levels(panorama);
        Ok(Environment {
            specular,
            backdrop: backdrop::upload(gpu, &levels)?,
            irradiance: rows(&irradiance::irradiance(&levels[0])),
        })
    }

    /// Reads the prefiltered reflections back, for storing: level by level from roughness 0 to 1, in each level the faces +X -X +Y -Y +Z
    /// -Z, in each face the rows from the top. A texel is four half floats, little-endian. The side of a face halves from level to level.
    pub fn prefiltered_bytes(&self, gpu: &Gpu) -> Result<Vec<u8>, ViewError> {
        cube_bytes::read(gpu, &self.specular)
    }

    /// Returns irradiance divided by pi, linear, at a normal of unit length. This is the radiance of a white diffuse surface.
    pub fn irradiance_at(&self, normal: Vec3) -> Vec3 {
        let row = |row: [f32; 4]| Vec4::from_array(row).truncate().as_dvec3();
        irradiance::evaluate(&self.irradiance.map(row), normal).as_vec3()
    }
}

/// Textures that pictures bind.
impl Environment {
    /// Prefiltered reflections by direction. The level of a perceptual roughness `r` is `r * (2 - r) * (levels - 1)`.
    pub(crate) fn specular(&self) -> wgpu::TextureView {
        prefilter::cube_view(&self.specular)
    }

    /// Levels of [`Environment::specular`].
    pub(crate) fn specular_levels(&self) -> u32 {
        self.specular.mip_level_count()
    }

    /// Returns the coefficients of irradiance divided by pi, linear. The irradiance is the sum of these rows times 1, x, y,
    /// z, xy, yz, zx, 3y² - 1 and x² - z² of a normal of unit length. The fourth number of a row is 0.
    pub(crate) fn irradiance(&self) -> [[f32; 4]; 9] {
        self.irradiance
    }

    /// Returns the panorama with all its mip levels; see [`Panorama::place`].
    pub(crate) fn backdrop(&self) -> wgpu::TextureView {
        self.backdrop.create_view(&Default::default())
    }
}

fn rows(coefficients: &[DVec3; 9]) -> [[f32; 4]; 9] {
    coefficients.map(|color| color.as_vec3().extend(0.0).to_array())
}
