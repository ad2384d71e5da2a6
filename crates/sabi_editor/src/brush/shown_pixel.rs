//! Pixels of strokes and stamps as colors of the window.

use egui::{Color32, Rgba};
use sabi_paint::SwatchPixel;

/// A pixel in its own color, or in that of paint.
pub(crate) fn shown_pixel(pixel: &SwatchPixel, paint: Color32) -> Color32 {
    match pixel.color {
        Some([red, green, blue]) => Color32::from(Rgba::from_rgb(red, green, blue) * pixel.strength),
        None => paint.gamma_multiply(pixel.strength),
    }
}
