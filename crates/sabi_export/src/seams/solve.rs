//! Linear least squares over the texels beside seams, by conjugate gradients whose sums have a fixed order: the same bits on
//! every machine and with any number of threads.

use rayon::prelude::*;

use super::SeamSample;
use super::footprint_places::FootprintPlaces;

/// Weight of a squared change of a texel, relative to a squared difference over one texel of seam. A difference that is
/// constant along the seam shrinks to this share of itself; one that varies from texel to texel shrinks less, since its
/// removal takes larger changes than the difference itself.
const CHANGE_WEIGHT: f64 = 0.03;
/// Relative residual at which iterations end.
const RESIDUAL_TOLERANCE: f64 = 1e-3;
/// Most iterations.
const MOST_ITERATIONS: usize = 100;
/// Texels of a part of a parallel task. Sums over parts have other last bits with another length; the seams of tests are short.
const PART: usize = if cfg!(test) { 16 } else { 1 << 12 };

/// For each side of a sample the rows that map a footprint to the compared values, and the first side's values minus the
/// second's.
pub(super) type ComparedRows<const N: usize, const K: usize> = ([[[f32; N]; K]; 2], [f64; K]);

/// Both sides of every sample, compared in `K` numbers; a texel has `N` values.
pub(super) struct SeamSystem<'a, const N: usize, const K: usize> {
    pub(super) samples: &'a [SeamSample],
    /// Samples of each texel.
    pub(super) readers: &'a FootprintPlaces,
    /// The rows of each sample.
    pub(super) rows: Vec<[[[f32; N]; K]; 2]>,
    /// The differences of each sample as they are.
    pub(super) differences: Vec<[f64; K]>,
}

impl<const N: usize, const K: usize> SeamSystem<'_, N, K> {
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
        let mut changes = vec![[0.0; N]; self.readers.texels()];
        let pulled: Vec<[f64; K]> = self
            .differences
            .iter()
            .map(|difference| difference.map(|x| -x))
            .collect();
        let mut residual = self.of_texels(|texel| self.transposed(texel, [0.0; N], &pulled));
        let scales = self.of_texels(|texel| self.scale(texel));
        let scaled = |residual: &[[f64; N]]| {
            self.of_texels(|texel| std::array::from_fn(|at| residual[texel][at] / scales[texel][at]))
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
            step = self.of_texels(|texel| std::array::from_fn(|at| toward[texel][at] + keep * step[texel][at]));
        }
        changes
    }

    /// The system's matrix times a vector.
    fn image(&self, vector: &[[f64; N]]) -> Vec<[f64; N]> {
        let compared: Vec<[f64; K]> = (0..self.samples.len())
            .into_par_iter()
            .map(|index| self.compared(index, vector))
            .collect();
        self.of_texels(|texel| self.transposed(texel, vector[texel].map(|x| CHANGE_WEIGHT * x), &compared))
    }

    /// A vector with the values that `of` returns for each texel.
    fn of_texels(&self, of: impl Fn(usize) -> [f64; N] + Send + Sync) -> Vec<[f64; N]> {
        let texels = (0..self.readers.texels()).into_par_iter();
        texels.with_min_len(PART).map(of).collect()
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

    /// Adds to the values of a texel the transpose of its samples' rows times `compared`, in the order of the samples, since the
    /// order of a sum decides its last bit.
    fn transposed(&self, texel: usize, values: [f64; N], compared: &[[f64; K]]) -> [f64; N] {
        let mut sum = values;
        for place in self.readers.of(texel) {
            let (index, side) = (place.sample(), place.side());
            let sample = &self.samples[index];
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let length = sign * f64::from(sample.length);
            let weight = sample.sides[side].weights()[place.corner()];
            for (at, sum) in sum.iter_mut().enumerate() {
                let rows = self.rows[index][side].iter().zip(compared[index]);
                let pull: f64 = rows.map(|(row, compared)| length * f64::from(row[at]) * compared).sum();
                *sum += weight * pull;
            }
        }
        sum
    }

    /// Returns the diagonal of the matrix at a texel; it is the preconditioner of the iterations.
    fn scale(&self, texel: usize) -> [f64; N] {
        let mut scale = [CHANGE_WEIGHT; N];
        for place in self.readers.of(texel) {
            let sample = &self.samples[place.sample()];
            let rows = &self.rows[place.sample()][place.side()];
            let weight = sample.sides[place.side()].weights()[place.corner()];
            for (at, scale) in scale.iter_mut().enumerate() {
                let squares: f64 = rows.iter().map(|row| f64::from(row[at]).powi(2)).sum();
                *scale += f64::from(sample.length) * weight * weight * squares;
            }
        }
        scale
    }
}

/// Scalar product, summed up in parts, which are the same with any number of threads.
fn dot<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> f64 {
    let parts = a.par_chunks(PART).zip(b.par_chunks(PART));
    let of_part = |(a, b): (&[[f64; N]], &[[f64; N]])| {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.map(|(a, b)| a * b).sum::<f64>()
    };
    let sums: Vec<f64> = parts.map(of_part).collect();
    sums.iter().sum()
}

fn add<const N: usize>(to: &mut [[f64; N]], from: &[[f64; N]], factor: f64) {
    let parts = to.par_chunks_mut(PART).zip(from.par_chunks(PART));
    parts.for_each(|(to, from)| {
        for (to, from) in to.as_flattened_mut().iter_mut().zip(from.as_flattened()) {
            *to += factor * from;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_several_parts_has_the_same_bits_with_any_number_of_threads() {
        let values: Vec<[f64; 3]> = (0..5 * PART + 7)
            .map(|at| [0.1, 0.7, -0.4].map(|factor| (at as f64 * factor).sin()))
            .collect();
        let product = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| dot(&values, &values).to_bits())
        };
        let alone = product(1);
        assert_eq!([2, 3, 8].map(product), [alone; 3]);
    }
}
