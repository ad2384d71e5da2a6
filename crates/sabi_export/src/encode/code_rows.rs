//! Rows of a file in integers.
//!
//! [`ComponentPlane::units`] returns the values of a row between 0 and 1, the sRGB curve is applied to colors, [`level`] scales the
//! values to codes, and each is rounded; in a gradient, the threshold of rounding is varied by noise.

use std::mem;
use std::ops::Range;

use sabi_color::{srgb_from_linear, srgb8_from_linear};
use sabi_image::{DitherPattern, DitheredRow, level, rounded};

use super::plane::ComponentPlane;

/// Whole number of a file.
pub(super) trait Code: Copy {
    const HIGHEST: f32;

    fn new(code: u32) -> Self;

    /// Returns the code of a value without dithering. `level` was computed from `unit`.
    fn rounded(unit: f32, level: f32, is_color: bool) -> Self;

    /// Returns the thresholds of a row.
    fn thresholds(pattern: DitherPattern, y: u32, is_color: bool) -> DitheredRow;
}

impl Code for u8 {
    const HIGHEST: f32 = 255.0;

    fn new(code: u32) -> u8 {
        code as u8
    }

    fn rounded(unit: f32, level: f32, is_color: bool) -> u8 {
        match is_color {
            true => srgb8_from_linear(unit),
            false => rounded(level) as u8,
        }
    }

    fn thresholds(pattern: DitherPattern, y: u32, is_color: bool) -> DitheredRow {
        match is_color {
            true => DitheredRow::inner(pattern, y),
            false => DitheredRow::new(pattern, y),
        }
    }
}

/// 16 bits, big-endian.
impl Code for [u8; 2] {
    const HIGHEST: f32 = 65535.0;

    fn new(code: u32) -> [u8; 2] {
        (code as u16).to_be_bytes()
    }

    fn rounded(_unit: f32, level: f32, _is_color: bool) -> [u8; 2] {
        Code::new(rounded(level))
    }

    fn thresholds(pattern: DitherPattern, y: u32, _is_color: bool) -> DitheredRow {
        DitheredRow::inner(pattern, y)
    }
}

/// Fills rows of a file with the codes of their pixels, components interleaved. `is_srgb` is true if the sRGB curve is
/// applied to all components, except the last of two or four.
pub(super) fn code_rows<C: Code>(
    planes: &[ComponentPlane<'_>],
    size: [u32; 2],
    is_srgb: bool,
    rows: Range<usize>,
    codes: &mut [C],
) {
    let count = planes.len().max(1);
    for (at, plane) in planes.iter().enumerate() {
        // Alpha is linear beside colors, too.
        let is_color = is_srgb && (at < 3 && !(count == 2 && at == 1));
        let component = SizedComponent {
            plane,
            size: size.map(|side| side as usize),
            is_color,
        };
        let row_codes = codes.chunks_exact_mut(component.size[0].max(1) * count);
        let slots = row_codes.map(|row| row.iter_mut().skip(at).step_by(count));
        match plane.dither() {
            None => component.round::<C>(rows.clone().zip(slots)),
            Some(pattern) => component.dither::<C>(pattern, rows.clone().zip(slots)),
        }
    }
}

/// Component of a file.
struct SizedComponent<'a> {
    plane: &'a ComponentPlane<'a>,
    /// Pixels across and down.
    size: [usize; 2],
    /// True if its values go through the sRGB curve.
    is_color: bool,
}

impl SizedComponent<'_> {
    /// Fills slots of rows with rounded codes.
    fn round<'c, C: Code + 'c>(&self, rows: impl Iterator<Item = (usize, impl Iterator<Item = &'c mut C>)>) {
        let mut values = RowValues::default();
        for (y, slots) in rows {
            values.fill::<C>(self, y);
            for ((slot, unit), level) in slots.zip(&values.units).zip(&values.levels) {
                *slot = C::rounded(*unit, *level, self.is_color);
            }
        }
    }

    /// Fills adjacent rows with codes, which are dithered where a neighbor differs by less than two codes. Dithering would
    /// only add noise to an area of constant value or to an edge, whose pixels differ by more.
    fn dither<'c, C: Code + 'c>(
        &self,
        pattern: DitherPattern,
        rows: impl Iterator<Item = (usize, impl Iterator<Item = &'c mut C>)>,
    ) {
        let [mut above, mut own, mut below] = [const { None::<RowValues> }; 3];
        let values = |y: usize, mut room: RowValues| {
            room.fill::<C>(self, y);
            room
        };
        let mut is_gentle = Vec::new();
        for (y, slots) in rows {
            if own.is_none() {
                above = y.checked_sub(1).map(|y| values(y, RowValues::default()));
            }
            let current = own.take().unwrap_or_else(|| values(y, RowValues::default()));
            let next = (y + 1 < self.size[1]).then_some(y + 1);
            // For the first row there is no earlier buffer to reuse.
            below = next.map(|next| values(next, below.take().unwrap_or_default()));
            let beside = [&above, &below].map(|row| row.as_ref().map(|row| &row.levels[..]));
            find_gentle_slopes(&current.levels, beside, &mut is_gentle);
            let thresholds = C::thresholds(pattern, y as u32, self.is_color);
            let values_of_row = current.units.iter().zip(&current.levels).zip(&is_gentle);
            for (x, (slot, ((unit, level), is_gentle))) in slots.zip(values_of_row).enumerate() {
                *slot = match is_gentle {
                    true => C::new(thresholds.code(*level, x)),
                    false => C::rounded(*unit, *level, self.is_color),
                };
            }
            // The buffer of the row above is reused for the next row below.
            own = mem::replace(&mut below, above.replace(current));
        }
    }
}

/// Values of a row.
#[derive(Default)]
struct RowValues {
    /// Linear, 0..1.
    units: Vec<f32>,
    /// Values in units of codes before rounding, with the sRGB curve applied to colors.
    levels: Vec<f32>,
}

impl RowValues {
    fn fill<C: Code>(&mut self, component: &SizedComponent<'_>, y: usize) {
        let width = component.size[0];
        self.units.resize(width, 0.0);
        component.plane.units(y * width..(y + 1) * width, &mut self.units);
        self.levels.clear();
        let units = self.units.iter();
        if component.is_color {
            self.levels
                .extend(units.map(|unit| level(srgb_from_linear(unit.clamp(0.0, 1.0)), C::HIGHEST)));
        } else {
            self.levels.extend(units.map(|unit| level(*unit, C::HIGHEST)));
        }
    }
}

/// Finds the pixels of a row that differ from a neighbor, but by less than two codes.
fn find_gentle_slopes(row: &[f32], beside: [Option<&[f32]>; 2], is_gentle: &mut Vec<bool>) {
    let gentle = |one: f32, other: f32| {
        let step = (one - other).abs();
        (step > 0.0) & (step < 2.0)
    };
    is_gentle.clear();
    is_gentle.resize(row.len(), false);
    for other in beside.into_iter().flatten() {
        for ((is_gentle, own), other) in is_gentle.iter_mut().zip(row).zip(other) {
            *is_gentle |= gentle(*own, *other);
        }
    }
    let Some(followers) = row.get(1..) else { return };
    for ((is_gentle, own), next) in is_gentle.iter_mut().zip(row).zip(followers) {
        *is_gentle |= gentle(*own, *next);
    }
    for ((is_gentle, own), before) in is_gentle.iter_mut().skip(1).zip(followers).zip(row) {
        *is_gentle |= gentle(*own, *before);
    }
}
