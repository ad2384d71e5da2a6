//! Values of a canvas on a square grid in the plane of a patch.

use glam::DVec2;

/// Minimum weight with which the value of a cell is used, in texels.
const LEAST_WEIGHT: f32 = 1e-3;

/// Values in the plane around a place, as weighted sums. Cells without surface have no weight.
pub(super) struct Grid {
    /// Cells along a side.
    side: usize,
    /// Width of a cell in model units.
    cell: f64,
    /// Distance of the borders from the middle.
    reach: f64,
    weights: Vec<f32>,
    /// Sum of the values of each channel times their weights.
    channels: Vec<Vec<f32>>,
}

impl Grid {
    /// An empty grid of `side` cells within `reach` of the middle.
    pub(super) fn new(reach: f64, side: usize, channels: usize) -> Grid {
        Grid {
            side,
            cell: 2.0 * reach / side as f64,
            reach,
            weights: vec![0.0; side * side],
            channels: vec![vec![0.0; side * side]; channels],
        }
    }

    /// Returns the four cells around a place, with their shares.
    fn around(&self, place: DVec2) -> impl Iterator<Item = (usize, f32)> + use<> {
        let side = self.side as f64;
        let at = (place + self.reach) / self.cell - 0.5;
        let corner = at.floor();
        let share = at - corner;
        (0..4_u32).filter_map(move |offset| {
            let step = DVec2::new(f64::from(offset & 1), f64::from(offset >> 1));
            let cell = corner + step;
            let is_inside = cell.cmpge(DVec2::ZERO).all() && cell.cmplt(DVec2::splat(side)).all();
            let weights = step * share + (1.0 - step) * (1.0 - share);
            is_inside.then(|| {
                (
                    cell.y as usize * side as usize + cell.x as usize,
                    (weights.x * weights.y) as f32,
                )
            })
        })
    }

    /// Adds the values of a texel at a place.
    pub(super) fn add(&mut self, place: DVec2, values: &[f32]) {
        for (cell, share) in self.around(place) {
            self.weights[cell] += share;
            for (channel, value) in self.channels.iter_mut().zip(values) {
                channel[cell] += share * value;
            }
        }
    }

    /// Writes the values at a place to `values`. Returns false if there is no surface.
    pub(super) fn read(&self, place: DVec2, values: &mut [f32]) -> bool {
        let mut weight = 0.0;
        values.fill(0.0);
        for (cell, share) in self.around(place) {
            weight += share * self.weights[cell];
            for (value, channel) in values.iter_mut().zip(&self.channels) {
                *value += share * channel[cell];
            }
        }
        for value in values.iter_mut() {
            *value /= weight.max(LEAST_WEIGHT);
        }
        weight > LEAST_WEIGHT
    }

    /// Returns the grid blurred with a Gaussian of this width in model units.
    pub(super) fn blurred(&self, width: f64) -> Grid {
        let sigma = (width / self.cell).max(1e-6);
        let taps = (3.0 * sigma).ceil().min(self.side as f64) as isize;
        let bell: Vec<f32> = (-taps..=taps)
            .map(|tap| (-0.5 * (tap as f64 / sigma).powi(2)).exp() as f32)
            .collect();
        let blur = |plane: &Vec<f32>| {
            let once = blurred_rows(plane, self.side, &bell);
            blurred_rows(&once, self.side, &bell)
        };
        Grid {
            weights: blur(&self.weights),
            channels: self.channels.iter().map(blur).collect(),
            ..*self
        }
    }
}

/// Returns the weighted sums of each cell's neighbors in its row, with rows and columns exchanged, so that applying it
/// twice blurs both directions.
fn blurred_rows(plane: &[f32], side: usize, bell: &[f32]) -> Vec<f32> {
    let taps = bell.len() / 2;
    let mut blurred = vec![0.0; plane.len()];
    for (y, row) in plane.chunks_exact(side).enumerate() {
        for x in 0..side {
            let low = x.saturating_sub(taps);
            let high = (x + taps).min(side - 1);
            let cells = &row[low..=high];
            let weights = &bell[low + taps - x..];
            blurred[x * side + y] = cells.iter().zip(weights).map(|(value, weight)| value * weight).sum();
        }
    }
    blurred
}
