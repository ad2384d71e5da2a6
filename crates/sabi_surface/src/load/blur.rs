//! Detects triangles that lose their shape, because 32-bit positions are too coarse at their distance from the origin.

use glam::DVec3;
use sabi_cancel::CancelableIterator as _;

use super::warnings::{TRIANGLES, Warnings, counted};

/// Maximum share of a triangle's longest edge by which rounding may move its corners. Below it the change of shape is not visible.
const MOST_MOVED: f64 = 1.0 / 16.0;
/// Minimum share of a mesh's triangles that must lose their shape for a warning: many models have a few triangles of tiny size.
const TOLD: f64 = 0.01;

/// Returns the number of triangles that lose their shape if their vertices, which are `exact`, move by an `error`; `None`
/// if they are too few for a warning.
pub(super) fn blurred(triangles: &[[u32; 3]], exact: impl Fn(usize) -> DVec3, error: impl Fn(usize) -> f64) -> usize {
    let is_blurred = |corners: &&[u32; 3]| {
        let corners = corners.map(|vertex| vertex as usize);
        let [a, b, c] = corners.map(&exact);
        let longest = [a - b, b - c, c - a].map(DVec3::length).into_iter().fold(0.0, f64::max);
        let moved = corners.map(&error).into_iter().fold(0.0, f64::max);
        // A triangle without edges has no shape to lose.
        longest > 0.0 && moved.is_finite() && moved > MOST_MOVED * longest
    };
    let count = triangles.iter().looking().filter(is_blurred).count();
    if count as f64 >= TOLD * triangles.len() as f64 {
        count
    } else {
        0
    }
}

/// Largest errors of coordinates that a file stores in 32 bits: half a step if the last bit is used, as it is after
/// rounding. On an axis on which no number uses it, numbers are considered exact.
pub(super) struct StorageErrors {
    /// Largest half step in use on each axis.
    half_steps: [f64; 3],
}

impl StorageErrors {
    pub(super) fn of(stored: impl Iterator<Item = [f32; 3]>) -> StorageErrors {
        let mut half_steps = [0.0; 3];
        for at in stored.looking() {
            for (most, x) in half_steps.iter_mut().zip(at) {
                if x.to_bits() & 1 == 1 {
                    *most = half_step(x).max(*most);
                }
            }
        }
        StorageErrors { half_steps }
    }

    /// Returns the largest error of a coordinate of a position.
    pub(super) fn at(&self, stored: [f32; 3]) -> f64 {
        let errors = stored.into_iter().zip(self.half_steps);
        errors.map(|(x, most)| half_step(x).min(most)).fold(0.0, f64::max)
    }
}

/// Returns half the distance to the next 32-bit number; `None` for NaN and infinity.
fn half_step(x: f32) -> f64 {
    let step = f64::from(x.abs().next_up() - x.abs());
    if step.is_finite() { step / 2.0 } else { 0.0 }
}

/// Adds a warning about triangles of `who` that lost their shape because the file stores them far from its origin.
pub(super) fn warn_of_storage(count: usize, who: &str, warnings: &mut Warnings) {
    if count > 0 {
        warnings.add(format!(
            "The shape of {} of {who} is lost in the file: it stores positions in 32 bits, which are too coarse so far from its \
             origin. Export the model near the origin.",
            counted(count, TRIANGLES)
        ));
    }
}

/// Adds a warning about triangles that lost their shape because positions of a model have 32 bits.
pub(super) fn warn_of_placing(count: usize, warnings: &mut Warnings) {
    if count > 0 {
        warnings.add(format!(
            "The shape of {} is lost: the model reaches so far that positions of 32 bits are too coarse for it. Export parts that \
             are far apart as models of their own, and leave out what lies far away.",
            counted(count, TRIANGLES)
        ));
    }
}
