//! Panoramas: radiance from all directions.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};
use rayon::prelude::*;

use crate::error::ViewError;

/// Maximum length of a side. Larger panoramas are reduced, since no picture shows more detail.
const MAX_SIDE: u32 = 8192;
/// Largest radiance: the largest half float. Brighter light is clamped to it.
pub(crate) const MAX_RADIANCE: f32 = 65504.0;

/// Linear radiance from all directions, by latitude and longitude as in OpenEXR: the top row looks to +Y, the middle of the
/// picture to +Z, and a quarter of the way from the left to +X. The value of a pixel is that at its center.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    width: u32,
    height: u32,
    /// Pixels row by row from the top. Each number is from 0 to `MAX_RADIANCE`.
    rgb: Vec<[f32; 3]>,
}

impl Panorama {
    /// Creates a panorama from linear pixels, row by row from the top. Alpha is ignored. Negative numbers and NaN become 0, and numbers
    /// larger than `MAX_RADIANCE` become `MAX_RADIANCE`. Also returns a sentence for each kind of value that was replaced.
    pub fn new(width: u32, height: u32, rgba: &[[f32; 4]]) -> Result<(Panorama, Vec<String>), ViewError> {
        let given = rgba.len() as u64;
        if given == 0 || given != u64::from(width) * u64::from(height) {
            return Err(ViewError::Panorama { width, height, given });
        }
        let is_light = |value: f32| value >= 0.0;
        let is_in_range = |value: f32| value <= MAX_RADIANCE;
        let count_without = |is_valid: &(dyn Fn(f32) -> bool + Sync)| {
            rgba.par_iter()
                .filter(|pixel| !pixel[..3].iter().all(|value| is_valid(*value)))
                .count()
        };
        let dark = count_without(&is_light);
        let bright = count_without(&|value| is_in_range(value) || value.is_nan());
        let clamped = |value: f32| if value > 0.0 { value.min(MAX_RADIANCE) } else { 0.0 };
        let rgb = rgba.par_iter().map(|[r, g, b, _]| [*r, *g, *b].map(clamped)).collect();
        let whole = Panorama { width, height, rgb };
        let sides = [width, height].map(|side| side.min(MAX_SIDE));
        let panorama = if sides == [width, height] {
            whole
        } else {
            whole.reduced(sides)
        };
        Ok((panorama, remarks([width, height], dark, bright)))
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top.
    pub fn rgb(&self) -> &[[f32; 3]] {
        &self.rgb
    }

    /// Returns the unit direction of a point of the picture. `uv` is 0 to 1 from the left and from the top.
    pub fn direction(uv: Vec2) -> Vec3 {
        let (longitude, latitude) = (PI * (1.0 - 2.0 * uv.x), PI * (0.5 - uv.y));
        let ([sin, cos], level) = ([longitude.sin(), longitude.cos()], latitude.cos());
        vec3(sin * level, latitude.sin(), cos * level)
    }

    /// Point of the picture for a direction of any length, 0 to 1 from the left and from the top.
    pub fn place(direction: Vec3) -> Vec2 {
        let latitude = direction.y.atan2(vec2(direction.x, direction.z).length());
        vec2(0.5 - direction.x.atan2(direction.z) / (2.0 * PI), 0.5 - latitude / PI)
    }

    /// Returns the panorama with fewer pixels. Each is the mean over its solid angle, so that the total light does not change.
    pub(crate) fn reduced(&self, [width, height]: [u32; 2]) -> Panorama {
        let columns = box_weights(self.width, width, |u| u);
        // The area of the sphere above a latitude grows with the cosine of the angle from the top.
        let rows = box_weights(self.height, height, |v| -(std::f64::consts::PI * v).cos());
        let line = |shares: &Vec<(usize, f32)>| {
            let mut sums = vec![Vec3::ZERO; self.width as usize];
            for (row, share) in shares {
                let source = &self.rgb[row * self.width as usize..][..self.width as usize];
                for (sum, pixel) in sums.iter_mut().zip(source) {
                    *sum += *share * Vec3::from(*pixel);
                }
            }
            let pixel = |shares: &Vec<(usize, f32)>| shares.iter().map(|(column, share)| *share * sums[*column]).sum();
            columns
                .iter()
                .map(|shares| Vec3::min(pixel(shares), Vec3::splat(MAX_RADIANCE)).to_array())
                .collect::<Vec<_>>()
        };
        let rgb = rows.par_iter().flat_map_iter(line).collect();
        Panorama { width, height, rgb }
    }
}

/// Returns sentences about replaced values and an unusual shape.
fn remarks([width, height]: [u32; 2], dark: usize, bright: usize) -> Vec<String> {
    let pixels = |count: usize| match count {
        1 => "1 pixel of the environment is".to_owned(),
        count => format!("{count} pixels of the environment are"),
    };
    let mut remarks = Vec::new();
    if dark > 0 {
        remarks.push(format!(
            "{} negative or no number; they count as 0, so save it again without them",
            pixels(dark)
        ));
    }
    if bright > 0 {
        remarks.push(format!(
            "{} brighter than {MAX_RADIANCE}; they count as {MAX_RADIANCE}, so light may be missing: darken the picture \
             and raise the exposure instead",
            pixels(bright)
        ));
    }
    if u64::from(width) != 2 * u64::from(height) && [width, height] != [1, 1] {
        remarks.push(format!(
            "the environment has {width} × {height} pixels and is stretched over the sphere; a latitude-longitude picture is \
             twice as wide as high"
        ));
    }
    remarks
}

/// Returns the weights of a box filter: for each of `target` equal parts of a line, the indices and weights of the `source`
/// parts that it covers. Weights add up to 1. `measure` is the cumulative measure at a place from 0 to 1.
fn box_weights(source: u32, target: u32, measure: impl Fn(f64) -> f64) -> Vec<Vec<(usize, f32)>> {
    let (source, target) = (u64::from(source), u64::from(target));
    let part = |at: u64| {
        // In these units a source part has the length `target`, and a target part the length `source`.
        let (start, end) = (at * source, (at + 1) * source);
        let length = |low: u64, high: u64| {
            let place = |units: u64| units as f64 / (source * target) as f64;
            measure(place(high)) - measure(place(low))
        };
        let whole = length(start, end);
        (start / target..end.div_ceil(target))
            .map(|own| {
                let overlap = length(start.max(own * target), end.min((own + 1) * target));
                (own as usize, (overlap / whole) as f32)
            })
            .collect()
    };
    (0..target).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_those_of_openexr() {
        let axes = [
            (vec2(0.5, 0.5), Vec3::Z),
            (vec2(0.25, 0.5), Vec3::X),
            (vec2(0.75, 0.5), Vec3::NEG_X),
            (vec2(0.0, 0.5), Vec3::NEG_Z),
            (vec2(1.0, 0.5), Vec3::NEG_Z),
            (vec2(0.5, 0.0), Vec3::Y),
            (vec2(0.5, 1.0), Vec3::NEG_Y),
        ];
        for (place, axis) in axes {
            assert!(
                Panorama::direction(place).distance(axis) < 1e-6,
                "{place} is not {axis}"
            );
        }
        for at in 0..200 {
            let place = vec2((0.1 + at as f32 * 0.618).fract(), (at as f32 + 0.5) / 200.0);
            let back = Panorama::place(3.0 * Panorama::direction(place));
            assert!(back.distance(place) < 1e-5, "{place} comes back as {back}");
        }
    }

    #[test]
    fn invalid_radiance_is_replaced_and_reported() {
        let mut pixels = vec![[0.5, 0.25, 1.0, 0.0]; 8];
        pixels[1] = [f32::NAN, 1.0, -2.0, 1.0];
        pixels[2] = [f32::INFINITY, 1e9, 3.0, 1.0];
        pixels[3] = [-f32::INFINITY, 0.0, 65504.0, 1.0];
        let (panorama, remarks) = Panorama::new(4, 2, &pixels).unwrap();
        assert_eq!(panorama.rgb()[0], [0.5, 0.25, 1.0]);
        assert_eq!(panorama.rgb()[1], [0.0, 1.0, 0.0]);
        assert_eq!(panorama.rgb()[2], [65504.0, 65504.0, 3.0]);
        assert_eq!(panorama.rgb()[3], [0.0, 0.0, 65504.0]);
        assert_eq!(
            remarks,
            [
                "2 pixels of the environment are negative or no number; they count as 0, so save it again without them",
                "1 pixel of the environment is brighter than 65504; they count as 65504, so light may be missing: darken \
                 the picture and raise the exposure instead",
            ]
        );
    }

    #[test]
    fn any_size_but_zero_is_allowed() {
        let (one, remarks) = Panorama::new(1, 1, &[[2.0; 4]]).unwrap();
        assert_eq!((one.rgb(), remarks.len()), (&[[2.0; 3]][..], 0));
        let (_, remarks) = Panorama::new(3, 3, &[[1.0; 4]; 9]).unwrap();
        assert_eq!(remarks.len(), 1);
        assert!(remarks[0].contains("3 × 3 pixels and is stretched"), "{remarks:?}");
        for (width, height, count) in [(0, 0, 0), (4, 0, 0), (2, 2, 3), (2, 2, 5), (u32::MAX, u32::MAX, 1)] {
            let error = Panorama::new(width, height, &vec![[1.0; 4]; count]).unwrap_err();
            assert!(error.to_string().contains("it needs at least one"), "{error}");
        }
    }

    #[test]
    fn a_reduced_panorama_has_the_same_light() {
        let (width, height) = (50, 23);
        let rgba: Vec<[f32; 4]> = (0..width * height)
            .map(|at| [(at as f32 * 0.37).fract() * 9.0, 1.0, (at % 7) as f32, 1.0])
            .collect();
        let (panorama, _) = Panorama::new(width, height, &rgba).unwrap();
        let reduced = panorama.reduced([17, 8]);
        let light = |panorama: &Panorama| -> Vec3 {
            let sphere = |(at, pixel): (usize, &[f32; 3])| {
                let step = std::f64::consts::PI / f64::from(panorama.height);
                let row = (at / panorama.width as usize) as f64;
                let share = ((step * row).cos() - (step * (row + 1.0)).cos()) / f64::from(panorama.width);
                share as f32 * Vec3::from(*pixel)
            };
            panorama.rgb.iter().enumerate().map(sphere).sum()
        };
        assert!(light(&panorama).abs_diff_eq(light(&reduced), 1e-4));
        assert!(reduced.rgb.iter().all(|pixel| (pixel[1] - 1.0).abs() < 1e-6));
    }

    #[test]
    fn a_picture_that_is_too_large_is_reduced() {
        let (panorama, _) = Panorama::new(8194, 2, &vec![[0.75; 4]; 8194 * 2]).unwrap();
        assert_eq!((panorama.width(), panorama.height()), (8192, 2));
        assert!(panorama.rgb().iter().flatten().all(|value| (value - 0.75).abs() < 1e-6));
    }
}
