//! Gradients that are picked from pictures: the colors along a line, as a few stops.

use std::path::Path;

use sabi_color::{linear_from_srgb8, oklab_from_linear, srgb8_from_linear};
use sabi_nodes::kind::WrittenStop;
use sabi_view::Pixels;

use crate::source::SessionPictures;
use crate::source::mip_chain::{PixelCurve, PixelReading};

/// Number of points along a line at which its color is measured.
const PLACES: usize = 128;
/// Half the width of the band around a line whose colors are averaged, as a share of the picture's longer side.
const BAND: f64 = 0.006;
/// Maximum distance in Oklab between a gradient and the colors from which it was picked: hardly visible side by side.
const ERROR: f32 = 0.015;
/// Factor by which the maximum error is raised until the number of stops is small enough.
const COARSER: f32 = 1.2;

/// Picture in display colors from which gradients are picked.
#[derive(Clone, Debug, PartialEq)]
pub struct PickedPicture {
    /// sRGB codes.
    pub pixels: Pixels,
}

impl PickedPicture {
    /// Reads an image file, reduced to at most `side` pixels along a side. The error is a sentence.
    pub fn read(pictures: &SessionPictures, file: &Path, side: u32) -> Result<PickedPicture, String> {
        let opened = pictures.open(file, &file.to_string_lossy(), "");
        let open = opened.map_err(|(why, _)| format!("The picture cannot be used: {why}."))?;
        let reading = PixelReading {
            curve: PixelCurve::Declared,
            by_alpha: true,
        };
        let levels = open.levels(reading, side);
        let level = levels.last();
        let [width, height] = levels.size(level);
        let places = (0..height as usize).flat_map(|y| (0..width as usize).map(move |x| (x, y)));
        let rgba = places.flat_map(|(x, y)| {
            let [r, g, b, _] = levels.pixel(level, x, y);
            let [r, g, b] = [r, g, b].map(srgb8_from_linear);
            [r, g, b, 255]
        });
        Ok(PickedPicture {
            pixels: Pixels {
                size: [width, height],
                rgba: rgba.collect(),
            },
        })
    }

    /// Picks a gradient along a line between two points, each 0 to 1 to the right and down. It has the fewest stops that
    /// are close to the colors of the picture, and at most `most`. If both points are the same, it has one color.
    pub fn gradient(&self, from: [f64; 2], to: [f64; 2], most: usize) -> Vec<WrittenStop> {
        let colors: Vec<[f32; 3]> = (0..PLACES)
            .map(|at| {
                let share = at as f64 / (PLACES - 1) as f64;
                self.band(from, to, share)
            })
            .collect();
        fitted(&colors, most.max(1))
    }

    /// Averages the colors across a line, in linear light.
    fn band(&self, from: [f64; 2], to: [f64; 2], share: f64) -> [f32; 3] {
        let size = self.pixels.size.map(f64::from);
        let [x, y] = [0, 1].map(|axis| (from[axis] + share * (to[axis] - from[axis])) * size[axis]);
        let along = [0, 1].map(|axis| (to[axis] - from[axis]) * size[axis]);
        let length = along[0].hypot(along[1]).max(1e-9);
        let across = [-along[1] / length, along[0] / length];
        let half = (BAND * size[0].max(size[1])).round();
        let mut sum = [0.0_f64; 3];
        for step in -(half as i64)..=half as i64 {
            let color = self.linear([x + step as f64 * across[0], y + step as f64 * across[1]]);
            for (sum, part) in sum.iter_mut().zip(color) {
                *sum += f64::from(part);
            }
        }
        sum.map(|sum| (sum / (2.0 * half + 1.0)) as f32)
    }

    /// Returns the linear color of the pixel at a place.
    fn linear(&self, place: [f64; 2]) -> [f32; 3] {
        let [column, row] = [0, 1].map(|axis: usize| {
            let last = f64::from(self.pixels.size[axis]) - 1.0;
            place[axis].floor().clamp(0.0, last.max(0.0)) as usize
        });
        let at = 4 * (row * self.pixels.size[0] as usize + column);
        match self.pixels.rgba.get(at..at + 3) {
            Some(&[r, g, b]) => linear_from_srgb8([r, g, b]),
            _ => [0.0; 3],
        }
    }
}

/// Fits a gradient to evenly spaced linear colors, with the fewest stops within the maximum error. The error is raised
/// until there are at most `most` stops.
fn fitted(colors: &[[f32; 3]], most: usize) -> Vec<WrittenStop> {
    let seen: Vec<[f32; 3]> = colors.iter().map(|color| oklab_from_linear(*color)).collect();
    let mut error = ERROR;
    // One stop is a single color.
    while !(is_even(&seen, error) || most >= 2 && fewest(colors, &seen, error).len() <= most) && error < 4.0 {
        error *= COARSER;
    }
    let places = if is_even(&seen, error) {
        vec![colors.len() / 2]
    } else {
        fewest(colors, &seen, error)
    };
    let last = (colors.len() - 1).max(1) as f64;
    let stop = |at: usize| WrittenStop {
        position: (1000.0 * at as f64 / last).round() / 1000.0,
        color: colors[at].map(srgb8_from_linear),
    };
    places.into_iter().map(stop).collect()
}

fn distance(left: [f32; 3], right: [f32; 3]) -> f32 {
    let square = |axis: usize| (left[axis] - right[axis]).powi(2);
    (square(0) + square(1) + square(2)).sqrt()
}

fn is_even(seen: &[[f32; 3]], error: f32) -> bool {
    let middle = seen[seen.len() / 2];
    seen.iter().all(|color| distance(*color, middle) <= error)
}

/// Returns the positions of the fewest stops, including both ends, such that no color in between differs by more than `error` from the
/// linear interpolation of the adjacent stops. This is the shortest path from the first to the last position.
fn fewest(colors: &[[f32; 3]], seen: &[[f32; 3]], error: f32) -> Vec<usize> {
    let fits = |from: usize, to: usize| {
        (from + 1..to).all(|at| {
            let share = (at - from) as f32 / (to - from) as f32;
            let mixed =
                std::array::from_fn(|part| colors[from][part] + share * (colors[to][part] - colors[from][part]));
            distance(oklab_from_linear(mixed), seen[at]) <= error
        })
    };
    // For each position: the number of stops up to it, and the previous stop.
    let mut ways: Vec<(usize, usize)> = vec![(0, 0)];
    for to in 1..colors.len() {
        let from = (0..to).filter(|from| fits(*from, to)).min_by_key(|from| ways[*from].0);
        let from = from.unwrap_or(to - 1);
        ways.push((ways[from].0 + 1, from));
    }
    let mut places = vec![colors.len() - 1];
    while let Some(&at) = places.last().filter(|at| **at > 0) {
        places.push(ways[at].1);
    }
    places.reverse();
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture whose columns have the colors of a gradient.
    fn ramp(stops: &[(f64, [u8; 3])]) -> PickedPicture {
        let width = 512_u32;
        let color = |x: u32| {
            let at = (f64::from(x) + 0.5) / f64::from(width);
            let after = stops
                .iter()
                .position(|(place, _)| *place > at)
                .unwrap_or(stops.len() - 1);
            let (left, right) = (stops[after.saturating_sub(1)], stops[after]);
            let share = ((at - left.0) / (right.0 - left.0).max(1e-9)).clamp(0.0, 1.0) as f32;
            let [from, to] = [left.1, right.1].map(linear_from_srgb8);
            let mixed: [f32; 3] = std::array::from_fn(|part| from[part] + share * (to[part] - from[part]));
            mixed.map(srgb8_from_linear)
        };
        let row: Vec<u8> = (0..width)
            .flat_map(|x| {
                let [r, g, b] = color(x);
                [r, g, b, 255]
            })
            .collect();
        PickedPicture {
            pixels: Pixels {
                size: [width, 16],
                rgba: row.repeat(16),
            },
        }
    }

    const RUST: [(f64, [u8; 3]); 4] = [
        (0.0, [20, 12, 10]),
        (0.3, [140, 60, 30]),
        (0.7, [210, 140, 60]),
        (1.0, [90, 90, 100]),
    ];

    #[test]
    fn a_gradient_is_picked_with_as_many_stops_as_it_was_drawn_with() {
        let picked = ramp(&RUST).gradient([0.0, 0.5], [1.0, 0.5], 16);
        assert_eq!(picked.len(), 4, "{picked:?}");
        for (stop, (at, color)) in picked.iter().zip(RUST) {
            assert!((stop.position - at).abs() < 0.04, "{picked:?}");
            let off = (0..3).map(|part| stop.color[part].abs_diff(color[part])).max();
            assert!(off <= Some(14), "{:?} for {color:?}", stop.color);
        }
    }

    #[test]
    fn a_line_in_the_other_direction_gives_the_reversed_gradient() {
        let there = ramp(&RUST).gradient([0.1, 0.5], [0.9, 0.5], 16);
        let back = ramp(&RUST).gradient([0.9, 0.5], [0.1, 0.5], 16);
        let ends = |stops: &[WrittenStop]| [stops[0].color, stops[stops.len() - 1].color];
        let [first, last] = ends(&there);
        for (left, right) in [first, last].iter().zip(ends(&back).iter().rev()) {
            assert!(
                (0..3).all(|part| left[part].abs_diff(right[part]) <= 2),
                "{left:?} {right:?}"
            );
        }
    }

    #[test]
    fn a_uniform_picture_gives_one_stop() {
        let even = ramp(&[(0.0, [90, 80, 70]), (1.0, [90, 80, 70])]);
        let picked = even.gradient([0.0, 0.0], [1.0, 1.0], 16);
        assert_eq!((picked.len(), picked[0].color), (1, [90, 80, 70]));
        // A line of length zero has one color.
        assert_eq!(ramp(&RUST).gradient([0.5, 0.5], [0.5, 0.5], 16).len(), 1);
    }

    #[test]
    fn a_busy_picture_gives_no_more_stops_than_there_is_room_for() {
        let busy: Vec<(f64, [u8; 3])> = (0..=60)
            .map(|at| (f64::from(at) / 60.0, if at % 2 == 0 { [0; 3] } else { [255, 200, 20] }))
            .collect();
        for most in [1, 2, 5, 16] {
            let picked = ramp(&busy).gradient([0.0, 0.5], [1.0, 0.5], most);
            assert!((1..=most).contains(&picked.len()), "{} of {most}", picked.len());
            assert!(picked.is_sorted_by(|left, right| left.position < right.position));
        }
    }
}
