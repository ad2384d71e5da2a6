//! Render targets.

mod bloom_levels;

use sabi_gpu::{Gpu, read_layer};

pub(crate) use self::bloom_levels::BloomLevels;
use crate::error::ViewError;
use crate::upload::texture;

/// Format of the light of one sample: linear, with coverage as alpha.
pub(crate) const LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of reversed depth. The stencil holds the number of a pixel's look, counted from 1.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;
/// Format of a visibility buffer, in two layers; see `raster.wgsl`.
pub(crate) const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Format of sums of samples.
pub(crate) const SUM_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of a finished picture: sRGB codes with straight alpha.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The longest side of a picture, pixels.
pub const LONGEST_SIDE: u32 = 8192;

/// Visibility buffer: the point of the model that each pixel of a picture shows, as the raster pass writes it.
pub(crate) struct VisibilityBuffer {
    /// Chart, place, normal and tangent of each pixel.
    pub(crate) record: wgpu::Texture,
    pub(crate) depth: wgpu::Texture,
}

impl VisibilityBuffer {
    /// Creates the textures for a number of pixels.
    pub(crate) fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<VisibilityBuffer, ViewError> {
        Ok(VisibilityBuffer {
            record: texture(
                gpu,
                "the visibility of a picture",
                [width, height, 2],
                VISIBILITY_FORMAT,
            )?,
            depth: texture(gpu, "the depth of a picture", [width, height, 1], DEPTH_FORMAT)?,
        })
    }
}

/// A picture on the device with its intermediate textures.
pub struct RenderTarget {
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    pub(crate) light: wgpu::Texture,
    pub(crate) visibility: VisibilityBuffer,
    /// Sums of samples, used alternately; `None` until a picture has several samples.
    pub(crate) sums: Option<[wgpu::TextureView; 2]>,
    /// Levels of the bloom; `None` until a picture has bloom.
    pub(crate) bloom: Option<BloomLevels>,
    pub(crate) shown: wgpu::Texture,
}

/// A finished picture in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Width and height.
    pub size: [u32; 2],
    /// sRGB codes with straight alpha, row by row from the top.
    pub rgba: Vec<u8>,
}

impl RenderTarget {
    /// Creates the textures for a picture of this size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<RenderTarget, ViewError> {
        let [width, height] = size;
        let longest = LONGEST_SIDE.min(gpu.device().limits().max_texture_dimension_2d);
        if width == 0 || height == 0 || width > longest || height > longest {
            return Err(ViewError::Size { width, height, longest });
        }
        let attachment = |what, format| texture(gpu, what, [width, height, 1], format);
        Ok(RenderTarget {
            size,
            light: attachment("the light of a picture", LIGHT_FORMAT)?,
            visibility: VisibilityBuffer::new(gpu, size)?,
            sums: None,
            bloom: None,
            shown: attachment("a picture", PICTURE_FORMAT)?,
        })
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the picture as a texture: sRGB codes in a linear format, straight alpha.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.shown
    }

    /// Reads the picture back.
    pub fn read(&self, gpu: &Gpu) -> Result<Pixels, ViewError> {
        let mut rgba = Vec::new();
        read_layer(gpu, &self.shown, 0, 0, &mut rgba)?;
        Ok(Pixels { size: self.size, rgba })
    }

    /// Reads back the light of the last sample: linear, scene-referred RGB and coverage, row by row from the top.
    pub fn read_light(&self, gpu: &Gpu) -> Result<Vec<[f32; 4]>, ViewError> {
        let mut bytes = Vec::new();
        read_layer(gpu, &self.light, 0, 0, &mut bytes)?;
        let pixel = |pixel: &[u8; 8]| {
            let half = |at: usize| half::f16::from_le_bytes([pixel[at], pixel[at + 1]]).to_f32();
            [half(0), half(2), half(4), half(6)]
        };
        let (pixels, _) = bytes.as_chunks::<8>();
        Ok(pixels.iter().map(pixel).collect())
    }

    /// Returns the textures for sums of samples, used alternately.
    pub(crate) fn sums(&mut self, gpu: &Gpu) -> Result<[wgpu::TextureView; 2], ViewError> {
        if let Some(sums) = &self.sums {
            return Ok(sums.clone());
        }
        let sum = || -> Result<wgpu::TextureView, ViewError> {
            let [width, height] = self.size;
            let made = texture(gpu, "the samples of a picture", [width, height, 1], SUM_FORMAT)?;
            Ok(made.create_view(&wgpu::TextureViewDescriptor::default()))
        };
        let sums = [sum()?, sum()?];
        self.sums = Some(sums.clone());
        Ok(sums)
    }
}
