//! Vertex colors, which the format does not define. They follow a position, as `x y z r g b` or `x y z r g b a`, or are in
//! comments `#MRGB` with eight digits for each vertex: mask, red, green and blue.

use sabi_color::linear_from_srgb;

use crate::load::color_codes::{LARGEST_CODE, are_codes};
use crate::load::warnings::Warnings;

/// Stands for the color of a position without one.
const ABSENT: [f32; 4] = [f32::INFINITY; 4];
/// Number of digits of a vertex in a comment.
const DIGITS: usize = 8;

/// Colors as stored in the file, sRGB.
#[derive(Default)]
pub(super) struct ObjColors {
    /// Colors of positions, by number of the position.
    behind_positions: Vec<[f32; 4]>,
    /// Colors of the file's vertices, in order.
    in_remarks: Vec<[f32; 4]>,
}

impl ObjColors {
    /// Adds the color of the position that follows `before` others. Positions without a color are white.
    pub(super) fn push(&mut self, before: usize, color: [f32; 4]) {
        self.behind_positions.resize(before, ABSENT);
        self.behind_positions.push(color);
    }

    /// Adds the colors of a comment.
    pub(super) fn push_mrgb(&mut self, digits: &str, warnings: &mut Warnings) {
        let (vertices, rest) = digits.as_bytes().as_chunks::<DIGITS>();
        let color = |digits: &[u8; DIGITS]| {
            let code = u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
            let [_, r, g, b] = code.to_be_bytes().map(|code| f32::from(code) / LARGEST_CODE);
            Some([r, g, b, 1.0])
        };
        let before = self.in_remarks.len();
        self.in_remarks.extend(vertices.iter().map_while(color));
        if self.in_remarks.len() - before < vertices.len() || !rest.is_empty() {
            warnings.add("Colors in a remark `#MRGB` are damaged; some vertices have none, or that of another.");
        }
    }

    /// Returns linear colors by number of the position. There may be fewer colors than positions.
    pub(super) fn linear(self, warnings: &mut Warnings) -> Vec<[f32; 4]> {
        let mut colors = self.behind_positions;
        if colors.is_empty() {
            colors = self.in_remarks;
        }
        let values = || colors.iter().filter(|color| **color != ABSENT).flatten().copied();
        let most = if are_codes(values().fold(0.0, f32::max), "vertices", warnings) {
            LARGEST_CODE
        } else {
            1.0
        };
        if values().any(|value| is_outside(value / most)) {
            warnings.add(
                "Some colors of vertices are below 0 or above full intensity; the nearest possible ones are taken.",
            );
        }
        for color in &mut colors {
            let [r, g, b, a] = *color;
            *color = if *color == ABSENT {
                [1.0; 4]
            } else {
                let light = |share: f32| linear_from_srgb((share / most).clamp(0.0, 1.0));
                let alpha = if a > 1.0 { a / most } else { a };
                [light(r), light(g), light(b), alpha.clamp(0.0, 1.0)]
            };
        }
        colors
    }
}

/// Returns true if a share is outside of 0 to 1 by more than rounding errors.
fn is_outside(share: f32) -> bool {
    !(-1e-3..=1.001).contains(&share)
}
