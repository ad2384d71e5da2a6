//! PNG textures as Sabi writes them.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{DVec2, DVec3};

/// A decoded texture of 8 bits a channel.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    width: usize,
    height: usize,
    /// Codes 0 to 1, three channels; gray ones are repeated.
    pixels: Vec<[f32; 3]>,
}

impl Texture {
    /// Reads a PNG file; the sentence says what is wrong with it.
    pub(crate) fn read(path: &Path) -> Result<Texture, String> {
        let fault = |error: &dyn std::fmt::Display| format!("{} cannot be read: {error}", path.display());
        let file = File::open(path).map_err(|error| fault(&error))?;
        let mut decoder = png::Decoder::new(BufReader::new(file));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|error| fault(&error))?;
        let size = reader.output_buffer_size().ok_or_else(|| fault(&"it is too large"))?;
        let mut bytes = vec![0; size];
        let info = reader.next_frame(&mut bytes).map_err(|error| fault(&error))?;
        let samples = info.color_type.samples();
        let pixels = bytes[..info.buffer_size()]
            .chunks_exact(samples)
            .map(|texel| {
                let code = |at: usize| f32::from(texel[at]) / 255.0;
                if samples < 3 {
                    [code(0); 3]
                } else {
                    [code(0), code(1), code(2)]
                }
            })
            .collect();
        Ok(Texture {
            width: info.width as usize,
            height: info.height as usize,
            pixels,
        })
    }

    /// Codes at a texture coordinate (v downward), between the four nearest texels.
    pub(crate) fn sample(&self, uv: DVec2) -> DVec3 {
        let x = (uv.x * self.width as f64 - 0.5).clamp(0.0, self.width as f64 - 1.0);
        let y = (uv.y * self.height as f64 - 0.5).clamp(0.0, self.height as f64 - 1.0);
        let (left, top) = (x as usize, y as usize);
        let at = |i: usize, j: usize| {
            let pixel = self.pixels[j.min(self.height - 1) * self.width + i.min(self.width - 1)];
            DVec3::from(pixel.map(f64::from))
        };
        let upper = at(left, top).lerp(at(left + 1, top), x - left as f64);
        let lower = at(left, top + 1).lerp(at(left + 1, top + 1), x - left as f64);
        upper.lerp(lower, y - top as f64)
    }
}

/// sRGB code 0..1 to linear.
pub(crate) fn linear_from_srgb(code: f64) -> f64 {
    if code <= 0.04045 {
        code / 12.92
    } else {
        ((code + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear to sRGB code 0..255.
pub(crate) fn srgb8_from_linear(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let code = if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (code * 255.0).round() as u8
}
