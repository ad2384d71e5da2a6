//! Rows of a file in integers.
//!
//! [`ComponentPlane::units`] returns the values of a row between 0 and 1, the sRGB curve is applied to colors, [`level`] scales the
//! values to codes, and each is rounded; in a gradient, the threshold of rounding is varied by noise.

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
        for (y, slots) in rows {
            let values = RowValues::new::<C>(self, y);
            for ((slot, unit), level) in slots.zip(&values.units).zip(&values.levels) {
                *slot = C::rounded(*unit, *level, self.is_color);
            }
        }
    }

    /// Fills adjacent rows with codes, which are dithered where a neighbor differs by less than two codes, and around
    /// plateaus of a shallow gradient. Dithering would only add noise to an area of constant value or to an edge, whose
    /// pixels differ by more.
    fn dither<'c, C: Code + 'c>(
        &self,
        pattern: DitherPattern,
        rows: impl Iterator<Item = (usize, impl Iterator<Item = &'c mut C>)>,
    ) {
        let slots: Vec<(usize, _)> = rows.collect();
        let Some(first) = slots.first().map(|(y, _)| *y) else {
            return;
        };
        let end = first + slots.len();
        // With the rows above and below, where there are some.
        let start = first.saturating_sub(1);
        let values: Vec<RowValues> = (start..(end + 1).min(self.size[1]))
            .map(|y| RowValues::new::<C>(self, y))
            .collect();
        let levels = |y: usize| values.get(y.checked_sub(start)?).map(|row| &row.levels[..]);
        let steps: Vec<RowSteps> = (first..end)
            .map(|y| {
                let beside = [y.checked_sub(1).and_then(levels), levels(y + 1)];
                RowSteps::of(&values[y - start].levels, beside)
            })
            .collect();
        let mut near_plateaus = vec![false; self.size[0].div_ceil(CELL)];
        for of_row in &steps {
            for (cell, is_plateau) in near_plateaus.iter_mut().zip(of_row.is_plateau.chunks(CELL)) {
                *cell |= is_plateau.contains(&true);
            }
        }
        let near_plateaus: Vec<bool> = (0..near_plateaus.len())
            .map(|at| near_plateaus[at.saturating_sub(1)..(at + 2).min(near_plateaus.len())].contains(&true))
            .collect();
        for ((y, slots), steps) in slots.into_iter().zip(&steps) {
            let row = &values[y - start];
            let thresholds = C::thresholds(pattern, y as u32, self.is_color);
            let values_of_row = row.units.iter().zip(&row.levels).zip(&steps.is_gentle);
            for (x, (slot, ((unit, level), is_gentle))) in slots.zip(values_of_row).enumerate() {
                *slot = match *is_gentle || near_plateaus[x / CELL] {
                    true => C::new(thresholds.code(*level, x)),
                    false => C::rounded(*unit, *level, self.is_color),
                };
            }
        }
    }
}

/// Side of the cells in which the plateaus of shallow gradients are found, pixels.
const CELL: usize = 32;
/// Longest step between two plateaus of a gradient, in codes of 8 bits: that of half floats below 1, with room for rounding.
const PLATEAU_STEP: f32 = 0.126;

/// Values of a row.
struct RowValues {
    /// Linear, 0..1.
    units: Vec<f32>,
    /// Values in units of codes before rounding, with the sRGB curve applied to colors.
    levels: Vec<f32>,
}

impl RowValues {
    fn new<C: Code>(component: &SizedComponent<'_>, y: usize) -> RowValues {
        let width = component.size[0];
        let mut units = vec![0.0; width];
        component.plane.units(y * width..(y + 1) * width, &mut units);
        let levels = match component.is_color {
            true => {
                let encoded = units.iter().map(|unit| srgb_from_linear(unit.clamp(0.0, 1.0)));
                encoded.map(|unit| level(unit, C::HIGHEST)).collect()
            }
            false => units.iter().map(|unit| level(*unit, C::HIGHEST)).collect(),
        };
        RowValues { units, levels }
    }
}

/// Steps between the pixels of a row and their neighbors.
struct RowSteps {
    /// True for pixels that differ from a neighbor, but by less than two codes.
    is_gentle: Vec<bool>,
    /// True for pixels that differ from a neighbor, but by no more than a [`PLATEAU_STEP`].
    is_plateau: Vec<bool>,
}

impl RowSteps {
    fn of(row: &[f32], beside: [Option<&[f32]>; 2]) -> RowSteps {
        let mut steps = RowSteps {
            is_gentle: vec![false; row.len()],
            is_plateau: vec![false; row.len()],
        };
        for other in beside.into_iter().flatten() {
            steps.compare(0, row, other);
        }
        if let Some(followers) = row.get(1..) {
            steps.compare(0, row, followers);
            steps.compare(1, followers, row);
        }
        steps
    }

    /// Compares pixels, of which `own` begins at a column, with others, pair by pair.
    fn compare(&mut self, column: usize, own: &[f32], others: &[f32]) {
        let found = self.is_gentle.iter_mut().zip(&mut self.is_plateau).skip(column);
        for ((is_gentle, is_plateau), (own, other)) in found.zip(own.iter().zip(others)) {
            let step = (own - other).abs();
            *is_gentle |= (step > 0.0) & (step < 2.0);
            *is_plateau |= (step > 0.0) & (step <= PLATEAU_STEP);
        }
    }
}
