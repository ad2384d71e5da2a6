//! Components of files, and the conversion of their pixels to the values in files.

use std::ops::Range;

use sabi_image::DitherPattern;

use crate::ChannelPixels;

/// How the values of a channel are mapped to 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CodeMapping {
    /// 0..1.
    Unit,
    /// Components of unit vectors, −1..1, where 0 becomes the middle code rounded up. Normals never point inward.
    Normal {
        /// True if green points down.
        is_down: bool,
    },
    /// Components of unit vectors in any direction, −1..1, also in float files. A vector without a direction becomes the middle code.
    Direction,
    /// −1..1. Floats are written unchanged.
    Signed,
    /// From the lowest to the highest value of the set, which are in the report. Floats are written unchanged.
    Range([f32; 2]),
    /// Like [`CodeMapping::Range`], also for floats.
    Normalized([f32; 2]),
    /// 0..1 after division by this number, which is in the report.
    Scaled(f32),
}

/// Component of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ComponentPlane<'a> {
    /// A component of a channel.
    Channel {
        pixels: &'a ChannelPixels,
        index: usize,
        codes: CodeMapping,
        is_inverted: bool,
        /// Arrangement of the noise, if gradients are dithered.
        dither: Option<DitherPattern>,
    },
    /// A single value everywhere, 0..1.
    Constant(f32),
}

/// All components of a channel, without dithering.
pub(crate) fn planes(pixels: &ChannelPixels, codes: CodeMapping) -> Vec<ComponentPlane<'_>> {
    let plane = |index| ComponentPlane::Channel {
        pixels,
        index,
        codes,
        is_inverted: false,
        dither: None,
    };
    (0..pixels.components).map(plane).collect()
}

impl ComponentPlane<'_> {
    /// Arrangement of the noise, if gradients are dithered.
    pub(super) fn dither(&self) -> Option<DitherPattern> {
        match self {
            ComponentPlane::Channel { dither, .. } => *dither,
            ComponentPlane::Constant(_) => None,
        }
    }

    /// Fills in the values of some pixels for integer files, 0..1. Inversion and the direction of green are applied here,
    /// before rounding, so that a flat normal stays the middle code.
    pub(super) fn units(&self, range: Range<usize>, units: &mut [f32]) {
        let ComponentPlane::Channel {
            pixels,
            index,
            codes,
            is_inverted,
            ..
        } = self
        else {
            return self.floats(range, units);
        };
        let at = *index;
        match *codes {
            CodeMapping::Unit => map_values(pixels, range, units, |values| values[at]),
            CodeMapping::Scaled(by) => map_values(pixels, range, units, |values| values[at] / by),
            CodeMapping::Direction => map_values(pixels, range, units, |values| direction(values)[at] * 0.5 + 0.5),
            CodeMapping::Signed => map_values(pixels, range, units, |values| values[at] * 0.5 + 0.5),
            CodeMapping::Normal { is_down } => {
                map_values(pixels, range, units, |values| normal(values, is_down)[at] * 0.5 + 0.5)
            }
            CodeMapping::Range([low, high]) | CodeMapping::Normalized([low, high]) if high > low => {
                map_values(pixels, range, units, |values| (values[at] - low) / (high - low))
            }
            CodeMapping::Range(_) | CodeMapping::Normalized(_) => units.fill(0.0),
        }
        if *is_inverted {
            units.iter_mut().for_each(|unit| *unit = 1.0 - *unit);
        }
    }

    /// Fills in the values of some pixels for floats.
    pub(super) fn floats(&self, range: Range<usize>, floats: &mut [f32]) {
        let ComponentPlane::Channel {
            pixels,
            index,
            codes,
            is_inverted,
            ..
        } = self
        else {
            let ComponentPlane::Constant(value) = self else { return };
            return floats.fill(*value);
        };
        let at = *index;
        let inverted = match *codes {
            CodeMapping::Unit | CodeMapping::Normal { .. } => return self.units(range, floats),
            CodeMapping::Normalized(_) | CodeMapping::Scaled(_) => {
                self.units(range, floats);
                // Ghosts beyond the charts may exceed the range; they are clamped as in integer files.
                return floats.iter_mut().for_each(|value| *value = value.clamp(0.0, 1.0));
            }
            CodeMapping::Range([low, high]) => {
                map_values(pixels, range, floats, |values| values[at]);
                low + high
            }
            CodeMapping::Direction => {
                map_values(pixels, range, floats, |values| direction(values)[at]);
                0.0
            }
            CodeMapping::Signed => {
                map_values(pixels, range, floats, |values| values[at]);
                0.0
            }
        };
        if *is_inverted {
            floats.iter_mut().for_each(|value| *value = inverted - *value);
        }
    }
}

/// Fills in values computed from some pixels.
fn map_values(pixels: &ChannelPixels, range: Range<usize>, out: &mut [f32], make: impl Fn(&[f32]) -> f32) {
    let components = pixels.components;
    let values = &pixels.data[range.start * components..range.end * components];
    // With a constant number of components, the compiler makes this much faster.
    match components {
        1 => {
            let (values, _) = values.as_chunks::<1>();
            out.iter_mut().zip(values).for_each(|(out, values)| *out = make(values));
        }
        3 => {
            let (values, _) = values.as_chunks::<3>();
            out.iter_mut().zip(values).for_each(|(out, values)| *out = make(values));
        }
        _ => {
            let values = values.chunks_exact(components.max(1));
            out.iter_mut().zip(values).for_each(|(out, values)| *out = make(values));
        }
    }
}

/// Returns a normal with unit length: padding, 16-bit storage and smaller maps may have changed it. A normal that points inward, which
/// maps of two channels cannot represent, is tilted to the surface. A vector without a direction becomes the flat normal.
fn normal(values: &[f32], is_down: bool) -> [f32; 3] {
    let [x, y, z] = match values {
        [x, y, z] => [*x, *y, z.max(0.0)],
        _ => [0.0; 3],
    };
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = match length > 1e-6 && length.is_finite() {
        true => [x, y, z].map(|part| part / length),
        false => [0.0, 0.0, 1.0],
    };
    [x, if is_down { -y } else { y }, z]
}

/// A vector of unit length, or 0 where it has no direction.
fn direction(values: &[f32]) -> [f32; 3] {
    let [x, y, z] = match values {
        [x, y, z] => [*x, *y, *z],
        _ => [0.0; 3],
    };
    let length = (x * x + y * y + z * z).sqrt();
    match length > 1e-6 && length.is_finite() {
        true => [x, y, z].map(|part| part / length),
        false => [0.0; 3],
    }
}
