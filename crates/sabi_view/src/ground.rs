//! The ground below a model on the device.

use sabi_gpu::Gpu;
use sabi_surface::ground::Ground as ModelGround;

use crate::error::ViewError;
use crate::placement::Placement;
use crate::upload::{texture, write};

/// Format of the openness.
pub(crate) const GROUND_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Ground that shows the shade of a model, in view space.
pub(crate) struct Ground {
    /// Height of the ground.
    pub(crate) height: f32,
    /// Radius around the vertical axis at which the shade has faded out.
    pub(crate) radius: f32,
    /// Share of the sky that is open, over a square of twice the radius.
    pub(crate) openness: wgpu::TextureView,
}

impl Ground {
    /// Uploads the ground below a model.
    pub(crate) fn new(gpu: &Gpu, ground: &ModelGround, placement: &Placement) -> Result<Ground, ViewError> {
        let side = ground.side as u32;
        let texture = texture(gpu, "the ground below the model", [side, side, 1], GROUND_FORMAT)?;
        let codes: Vec<u8> = ground
            .openness
            .iter()
            .map(|open| (open * 255.0).round() as u8)
            .collect();
        write(gpu, &texture, &codes);
        let height = (f64::from(ground.height) - placement.center[1]) * placement.scale;
        Ok(Ground {
            height: height as f32,
            radius: (f64::from(ground.radius) * placement.scale) as f32,
            openness: texture.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }
}
