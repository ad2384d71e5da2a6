//! Linear least squares over the texels beside seams, by conjugate gradients in a fixed order: the same bits on every
//! machine and with any number of threads.

use rayon::prelude::*;

use super::Sample;

/// Weight of a squared change of a texel, relative to a squared difference over one texel of seam. A difference that is
/// constant along the seam shrinks to this share of itself; one that varies from texel to texel shrinks less, since its
/// removal takes larger changes than the difference itself.
const CHANGE_WEIGHT: f64 = 0.03;
/// Relative residual at which iterations end.
const RESIDUAL_TOLERANCE: f64 = 1e-3;
/// Most iterations.
const MOST_ITERATIONS: usize = 100;

/// For each side of a sample the rows that map a footprint to the compared values, and the first side's values minus the
/// second's.
pub(super) type Compared<const N: usize, const K: usize> = ([[[f32; N]; K]; 2], [f64; K]);

/// Both sides of every sample, compared in `K` numbers; a texel has `N` values.
pub(super) struct System<'a, const N: usize, const K: usize> {
    pub(super) samples: &'a [Sample],
    /// Number of texels.
    pub(super) texels: usize,
    /// The rows of each sample.
    pub(super) rows: Vec<[[[f32; N]; K]; 2]>,
    /// The differences of each sample as they are.
    pub(super) differences: Vec<[f64; K]>,
}

impl<const N: usize, const K: usize> System<'_, N, K> {
    /// Returns the mean of the squared differences along all seams that are compared.
    pub(super) fn mean_square(&self) -> f64 {
        let (mut sum, mut length) = (0.0, 0.0);
        let each = self.samples.iter().zip(&self.rows).zip(&self.differences);
        for ((sample, _), difference) in each.filter(|((_, rows), _)| **rows != [[[0.0; N]; K]; 2]) {
            sum += f64::from(sample.length) * difference.iter().map(|x| x * x).sum::<f64>();
            length += f64::from(sample.length);
        }
        if length > 0.0 { sum / length } else { 0.0 }
    }

    /// Solves for the changes of all texels.
    pub(super) fn changes(&self) -> Vec<[f64; N]> {
        let mut changes = vec![[0.0; N]; self.texels];
        let mut residual = vec![[0.0; N]; self.texels];
        for (index, difference) in self.differences.iter().enumerate() {
            self.scatter(index, difference.map(|x| -x), &mut residual);
        }
        let scales = self.scales();
        let scaled = |residual: &[[f64; N]]| -> Vec<[f64; N]> {
            let pairs = residual.iter().zip(&scales);
            pairs
                .map(|(values, scale)| std::array::from_fn(|at| values[at] / scale[at]))
                .collect()
        };
        let mut toward = scaled(&residual);
        let mut step = toward.clone();
        let mut size = dot(&residual, &toward);
        let target = size * RESIDUAL_TOLERANCE * RESIDUAL_TOLERANCE;
        for _ in 0..MOST_ITERATIONS {
            // False for what is not a number, too.
            if !(size > target && size.is_finite()) {
                break;
            }
            let image = self.image(&step);
            let stride = size / dot(&step, &image);
            add(&mut changes, &step, stride);
            add(&mut residual, &image, -stride);
            toward = scaled(&residual);
            let before = std::mem::replace(&mut size, dot(&residual, &toward));
            let keep = size / before;
            for (step, toward) in step.iter_mut().zip(&toward) {
                *step = std::array::from_fn(|at| toward[at] + keep * step[at]);
            }
        }
        changes
    }

    /// The system's matrix times a vector.
    fn image(&self, vector: &[[f64; N]]) -> Vec<[f64; N]> {
        let mut image: Vec<[f64; N]> = vector.iter().map(|values| values.map(|x| CHANGE_WEIGHT * x)).collect();
        let compared: Vec<[f64; K]> = (0..self.samples.len())
            .into_par_iter()
            .map(|index| self.compared(index, vector))
            .collect();
        // In the order of the samples, since the order of a sum decides its last bit.
        for (index, compared) in compared.into_iter().enumerate() {
            self.scatter(index, compared, &mut image);
        }
        image
    }

    /// A sample's rows times the values of its footprints, of the first side minus the second.
    fn compared(&self, index: usize, vector: &[[f64; N]]) -> [f64; K] {
        let mut compared = [0.0; K];
        for (side, footprint) in self.samples[index].sides.iter().enumerate() {
            let mut read = [0.0; N];
            for (weight, texel) in footprint.weights().into_iter().zip(footprint.texels) {
                let values = &vector[texel as usize];
                for at in 0..N {
                    read[at] += weight * values[at];
                }
            }
            for (row, compared) in self.rows[index][side].iter().zip(&mut compared) {
                let product: f64 = row.iter().zip(&read).map(|(a, b)| f64::from(*a) * b).sum();
                *compared += if side == 0 { product } else { -product };
            }
        }
        compared
    }

    /// Adds the transpose of a sample's rows times `compared` to the texels of its footprints.
    fn scatter(&self, index: usize, compared: [f64; K], to: &mut [[f64; N]]) {
        let sample = &self.samples[index];
        for (side, footprint) in sample.sides.iter().enumerate() {
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let mut pull = [0.0; N];
            for (row, compared) in self.rows[index][side].iter().zip(compared) {
                for at in 0..N {
                    pull[at] += sign * f64::from(sample.length) * f64::from(row[at]) * compared;
                }
            }
            for (weight, texel) in footprint.weights().into_iter().zip(footprint.texels) {
                let values = &mut to[texel as usize];
                for at in 0..N {
                    values[at] += weight * pull[at];
                }
            }
        }
    }

    /// Returns the diagonal of the matrix, the preconditioner of the iterations.
    fn scales(&self) -> Vec<[f64; N]> {
        let mut scales = vec![[CHANGE_WEIGHT; N]; self.texels];
        for (sample, rows) in self.samples.iter().zip(&self.rows) {
            for (footprint, rows) in sample.sides.iter().zip(rows) {
                for (weight, texel) in footprint.weights().into_iter().zip(footprint.texels) {
                    for at in 0..N {
                        let squares: f64 = rows.iter().map(|row| f64::from(row[at]).powi(2)).sum();
                        scales[texel as usize][at] += f64::from(sample.length) * weight * weight * squares;
                    }
                }
            }
        }
        scales
    }
}

fn dot<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.map(|(a, b)| a * b).sum()
}

fn add<const N: usize>(to: &mut [[f64; N]], from: &[[f64; N]], factor: f64) {
    for (to, from) in to.as_flattened_mut().iter_mut().zip(from.as_flattened()) {
        *to += factor * from;
    }
}
