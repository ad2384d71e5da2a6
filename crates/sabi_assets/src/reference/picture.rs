//! PNG textures as Sabi writes them.

use glam::{DVec2, DVec3};

use crate::small_png::RgbPicture;

/// Texture of 8 bits a channel.
#[derive(Clone, Debug)]
pub(crate) struct Texture(pub(crate) RgbPicture);

impl Texture {
    /// Interpolates the codes, 0 to 1, of the four texels nearest to a texture coordinate (v downward).
    pub(crate) fn sample(&self, uv: DVec2) -> DVec3 {
        let RgbPicture {
            size: [width, height],
            pixels,
        } = &self.0;
        let x = (uv.x * *width as f64 - 0.5).clamp(0.0, *width as f64 - 1.0);
        let y = (uv.y * *height as f64 - 0.5).clamp(0.0, *height as f64 - 1.0);
        let (left, top) = (x as usize, y as usize);
        let at = |i: usize, j: usize| {
            let pixel = pixels[j.min(height - 1) * width + i.min(width - 1)];
            // Single precision, as the committed pictures were drawn with.
            DVec3::from(pixel.map(|code| f64::from(f32::from(code) / 255.0)))
        };
        let upper = at(left, top).lerp(at(left + 1, top), x - left as f64);
        let lower = at(left, top + 1).lerp(at(left + 1, top + 1), x - left as f64);
        upper.lerp(lower, y - top as f64)
    }
}

/// Decodes an sRGB code from 0 to 1.
pub(crate) fn linear_from_srgb(code: f64) -> f64 {
    if code <= 0.04045 {
        code / 12.92
    } else {
        ((code + 0.055) / 1.055).powf(2.4)
    }
}

/// Encodes a linear value as an sRGB code from 0 to 255.
pub(crate) fn srgb8_from_linear(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let code = if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (code * 255.0).round() as u8
}
