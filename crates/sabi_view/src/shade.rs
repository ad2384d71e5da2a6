//! Shade of a model on itself and on the ground below it, on the device.

use sabi_gpu::Gpu;
use sabi_surface::ground::Ground as ModelGround;
use sabi_surface::openness::Openness as ModelOpenness;

use crate::error::ViewError;
use crate::placement::Placement;
use crate::upload::{table_of, texture, write};

/// Format of the openness of the ground.
pub(crate) const GROUND_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Shade of a model. Parts that could not be computed are left out.
pub(crate) struct Shade {
    pub(crate) ground: Option<GroundShade>,
    pub(crate) openness: Option<OpennessTextures>,
}

/// Ground that shows the shade of a model, in view space.
pub(crate) struct GroundShade {
    /// Height of the ground.
    pub(crate) height: f32,
    /// Radius around the vertical axis at which the shade has faded out.
    pub(crate) radius: f32,
    /// Share of the sky that is not hidden, over a square with a side of twice the radius.
    pub(crate) openness: wgpu::TextureView,
}

/// Openness of the model's surface, on its own atlas.
pub(crate) struct OpennessTextures {
    /// Texels per unit of UV.
    pub(crate) size: f32,
    /// Mean open direction, −1..1 stored as 0..1, and the open share.
    pub(crate) texels: wgpu::TextureView,
    /// For each chart, its page and the offset from UVs in texels to texels on the page.
    pub(crate) charts: wgpu::TextureView,
}

impl GroundShade {
    pub(crate) fn new(gpu: &Gpu, ground: &ModelGround, placement: &Placement) -> Result<GroundShade, ViewError> {
        let side = ground.side as u32;
        let texture = texture(gpu, "the ground below the model", [side, side, 1], GROUND_FORMAT)?;
        let codes: Vec<u8> = ground
            .openness
            .iter()
            .map(|open| (open * 255.0).round() as u8)
            .collect();
        write(gpu, &texture, &codes);
        let height = (f64::from(ground.height) - placement.center[1]) * placement.scale;
        Ok(GroundShade {
            height: height as f32,
            radius: (f64::from(ground.radius) * placement.scale) as f32,
            openness: texture.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }
}

impl OpennessTextures {
    pub(crate) fn new(gpu: &Gpu, openness: &ModelOpenness) -> Result<OpennessTextures, ViewError> {
        let [width, height] = openness.page_size;
        let size = [width, height, openness.pages];
        let texture = texture(gpu, "the openness of the model", size, wgpu::TextureFormat::Rgba8Unorm)?;
        write(gpu, &texture, openness.texels.as_flattened());
        let row = |[u, v, page]: &[i32; 3]| [*u as f32, *v as f32, *page as f32, 0.0];
        let rows: Vec<[f32; 4]> = openness.charts.iter().map(row).collect();
        Ok(OpennessTextures {
            size: openness.size as f32,
            texels: texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
            charts: table_of(gpu, "the charts of the model's openness", &rows)?,
        })
    }
}
