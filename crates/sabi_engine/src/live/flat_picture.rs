//! Thumbnails in texture space.

use sabi_export::SetKey;
use sabi_gpu::Run;
use sabi_plan::{Plan, PlannedResult};
use sabi_view::Pixels;

use super::sized_model::{SizedModel, no_texture_space};
use crate::error::EngineError;
use crate::evaluating::texture_space::rgb_codes;

impl SizedModel {
    /// Draws a result in texture space as a square picture, transparent where there is no chart.
    pub(super) fn flat_picture(
        &mut self,
        plan: &Plan,
        run: &Run,
        result: &PlannedResult,
        side: u32,
        set: Option<SetKey>,
    ) -> Result<Pixels, EngineError> {
        let (evaluator, _, texture_space) = self.texture_space(set)?;
        let planes = texture_space.planes(evaluator, plan, run, result)?;
        let plane = planes.first().ok_or_else(no_texture_space)?;
        let code = |pixel: usize| {
            let values = &plane.values[pixel * plane.components..][..plane.components];
            rgb_codes(result.stored.ty, values)
        };
        Ok(Pixels {
            size: [side; 2],
            rgba: reduced(
                texture_space.layout.size as usize,
                side as usize,
                &texture_space.is_owned(),
                code,
            ),
        })
    }
}

/// Resizes a square picture. Each pixel is the mean of those covered pixels that are on a chart, or the nearest one.
fn reduced(from: usize, to: usize, is_there: &[bool], code: impl Fn(usize) -> [u8; 3]) -> Vec<u8> {
    let range = |at: usize| {
        let start = at * from / to;
        start..((at + 1) * from / to).max(start + 1).min(from)
    };
    let mut rgba = Vec::with_capacity(4 * to * to);
    for row in 0..to {
        for column in 0..to {
            let rows = range(row);
            let covered = rows.len() * range(column).len();
            let pixels = rows.flat_map(|y| range(column).map(move |x| y * from + x));
            let mut sum = [0_usize; 3];
            let mut count = 0;
            for pixel in pixels.filter(|pixel| is_there[*pixel]) {
                let own = code(pixel);
                sum = [0, 1, 2].map(|at| sum[at] + usize::from(own[at]));
                count += 1;
            }
            rgba.extend(sum.map(|sum| (sum / count.max(1)) as u8));
            rgba.push((255 * count / covered.max(1)) as u8);
        }
    }
    rgba
}

#[cfg(test)]
mod tests {
    use super::reduced;

    #[test]
    fn a_pixel_is_the_mean_of_the_pixels_on_charts() {
        // Two by two pixels become one. The last of them is not on a chart.
        let codes = [[0, 0, 0], [90, 0, 0], [0, 0, 30], [255; 3]];
        let one = reduced(2, 1, &[true, true, true, false], |pixel| codes[pixel]);
        assert_eq!(one, [30, 0, 10, 191]);
        let none = reduced(2, 1, &[false; 4], |pixel| codes[pixel]);
        assert_eq!(none, [0, 0, 0, 0]);
    }

    #[test]
    fn a_smaller_picture_is_enlarged() {
        let larger = reduced(1, 2, &[true], |_| [7, 8, 9]);
        assert_eq!(larger, [7, 8, 9, 255].repeat(4));
    }
}
