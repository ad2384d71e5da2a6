//! Maps of other sizes than those of the bake.

use rayon::prelude::*;

use crate::ChannelPixels;

/// Parts of the source's pixels that one pixel covers along a side: index and share, which sum up to 1.
type Shares = Vec<(usize, f32)>;

/// Returns the pixels of a square channel of `size` as `width × height` ones: the mean over the area of each, so that nothing
/// is skipped. Larger maps repeat pixels.
pub(crate) fn resized(pixels: &ChannelPixels, size: u32, [width, height]: [u32; 2]) -> ChannelPixels {
    let components = pixels.components;
    let (columns, rows) = (shares(size, width), shares(size, height));
    let mut data = vec![0.0; width as usize * height as usize * components];
    data.par_chunks_mut((width as usize * components).max(1))
        .zip(&rows)
        .for_each(|(out, row)| {
            for (pixel, column) in out.chunks_exact_mut(components).zip(&columns) {
                for (y, in_row) in row {
                    for (x, in_column) in column {
                        let start = (y * size as usize + x) * components;
                        let values = &pixels.data[start..start + components];
                        for (sum, value) in pixel.iter_mut().zip(values) {
                            *sum += value * in_row * in_column;
                        }
                    }
                }
            }
        });
    ChannelPixels { components, data }
}

/// The shares of `from` pixels in each of `to` pixels of the same side.
fn shares(from: u32, to: u32) -> Vec<Shares> {
    let (from, to) = (u64::from(from), u64::from(to));
    // In units of 1/(from × to) of the side, which are whole numbers.
    let of = |pixel: u64| {
        let (start, end) = (pixel * from, (pixel + 1) * from);
        let touched = start / to..=(end - 1) / to;
        let share = |source: u64| {
            let (first, last) = (start.max(source * to), end.min((source + 1) * to));
            (source as usize, (last - first) as f32 / from as f32)
        };
        touched.map(share).collect()
    };
    (0..to).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(data: &[f32]) -> ChannelPixels {
        ChannelPixels {
            components: 1,
            data: data.to_vec(),
        }
    }

    #[test]
    fn a_smaller_map_has_the_means_of_areas() {
        let square = gray(&[
            1.0, 3.0, 5.0, 7.0, 1.0, 3.0, 5.0, 7.0, 0.0, 0.0, 0.0, 0.0, 8.0, 8.0, 8.0, 8.0,
        ]);
        assert_eq!(resized(&square, 4, [2, 2]).data, [2.0, 6.0, 4.0, 4.0]);
        assert_eq!(
            resized(&square, 4, [1, 4]).data,
            [4.0, 4.0, 0.0, 8.0],
            "a side of its own"
        );
    }

    #[test]
    fn sizes_that_do_not_divide_weigh_pixels_by_their_area() {
        let row = gray(&[0.0, 3.0, 6.0, 0.0, 3.0, 6.0, 0.0, 3.0, 6.0]);
        let half = resized(&row, 3, [2, 1]).data;
        for (value, expected) in half.iter().zip([1.0, 5.0]) {
            assert!((value - expected).abs() < 1e-6, "{half:?}");
        }
    }

    #[test]
    fn a_larger_map_repeats_pixels_and_the_same_size_changes_nothing() {
        let square = gray(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(resized(&square, 2, [2, 2]), square);
        assert_eq!(
            resized(&square, 2, [4, 2]).data,
            [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0]
        );
    }
}
