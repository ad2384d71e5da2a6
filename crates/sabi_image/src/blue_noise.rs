//! Thresholds for dithering: a tile of blue noise, computed with integers.

use std::sync::OnceLock;

const SIDE: usize = DitherPattern::SIDE;
const CELLS: usize = SIDE * SIDE;
/// Number of pixels in the initial pattern: one in ten, as recommended by Ulichney.
const FIRST: usize = CELLS / 10;
/// 1, 2^(-1/3) and 2^(-2/3), times 2^50.
const CUBE_ROOTS: [u64; 3] = [1_125_899_906_842_624, 893_627_348_266_440, 709_272_496_352_849];
/// Largest squared distance at which a pixel has an effect. Beyond it the weight is 0.
const FARTHEST: usize = 150;

/// Arrangement of the thresholds of one channel: the tile, shifted, mirrored and rotated according to a hash of seed and channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DitherPattern {
    hash: u32,
}

impl DitherPattern {
    /// Pixels along a side of the tile, after which thresholds repeat.
    pub(crate) const SIDE: usize = 64;

    /// Creates the pattern of a channel. Patterns of different seeds and channels are arranged differently, so that the
    /// noise of several channels does not add up.
    pub fn new(seed: u32, channel: &str, component: usize) -> DitherPattern {
        let named = channel
            .bytes()
            .fold(pcg(seed), |hash, byte| pcg(hash ^ u32::from(byte)));
        DitherPattern {
            hash: pcg(named ^ component as u32),
        }
    }

    /// Returns the threshold of a pixel, above 0 and below 1. Its distance from both is at least 1/8192, which is more than
    /// the rounding error of a float that represents a code of 8 bits, so that exact codes are not changed.
    pub(crate) fn threshold(self, x: u32, y: u32) -> f32 {
        let bit = |at: u32| self.hash >> at & 1 == 1;
        let (x, y) = if bit(16) { (y, x) } else { (x, y) };
        let place = |at: u32, first: u32, is_mirrored: bool| {
            let at = if is_mirrored { !at } else { at };
            at.wrapping_add(self.hash >> first) as usize % SIDE
        };
        let rank = tile()[place(y, 6, bit(17)) * SIDE + place(x, 0, bit(18))];
        (f32::from(rank) + 0.5) / CELLS as f32
    }

    /// Returns the threshold of a pixel between 1/64 and 63/64, for codes that floats represent with an error of up to 1/256.
    pub(crate) fn inner_threshold(self, x: u32, y: u32) -> f64 {
        1.0 / 64.0 + f64::from(self.threshold(x, y)) * 31.0 / 32.0
    }
}

/// Returns the rank of each pixel of the tile, computed on first use.
fn tile() -> &'static [u16] {
    static TILE: OnceLock<Vec<u16>> = OnceLock::new();
    TILE.get_or_init(ranks)
}

/// PCG hash. Source: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9.3, 2020.
fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Pattern of set pixels, with the energy that they cause at each pixel of the tile. The tile repeats.
#[derive(Clone)]
struct PixelPattern {
    is_set: Vec<bool>,
    energy: Vec<u64>,
}

impl PixelPattern {
    /// Sets or clears a pixel. Its energy falls with the squared distance d² as 2^(-d²/3): a Gaussian with a standard deviation of about
    /// 1.5 pixels, which Ulichney found best. It is computed with integers, so that every machine produces the same tile.
    fn put(&mut self, cell: usize, is_set: bool) {
        self.is_set[cell] = is_set;
        let (x, y) = (cell % SIDE, cell / SIDE);
        let reach = FARTHEST.isqrt();
        for row in 0..=2 * reach {
            for column in 0..=2 * reach {
                let squared = row.abs_diff(reach).pow(2) + column.abs_diff(reach).pow(2);
                if squared > FARTHEST {
                    continue;
                }
                let at = (y + SIDE + row - reach) % SIDE * SIDE + (x + SIDE + column - reach) % SIDE;
                let weight = CUBE_ROOTS[squared % 3] >> (squared / 3);
                self.energy[at] = match is_set {
                    true => self.energy[at] + weight,
                    false => self.energy[at] - weight,
                };
            }
        }
    }

    /// Returns the set pixel with the most set pixels around it.
    fn tightest_cluster(&self) -> usize {
        let set = (0..CELLS).filter(|cell| self.is_set[*cell]);
        set.max_by_key(|cell| self.energy[*cell]).unwrap_or(0) // There is always a set pixel when this is called.
    }

    /// Returns the clear pixel with the fewest set pixels around it.
    fn largest_void(&self) -> usize {
        let clear = (0..CELLS).filter(|cell| !self.is_set[*cell]);
        clear.min_by_key(|cell| self.energy[*cell]).unwrap_or(0) // There is always a clear pixel when this is called.
    }
}

/// Returns the ranks of the pixels by the void-and-cluster method. The pixels below any rank are evenly distributed,
/// without low frequencies. Source: Ulichney, "The void-and-cluster method for dither array generation", SPIE 1913, 1993.
fn ranks() -> Vec<u16> {
    let mut first = PixelPattern {
        is_set: vec![false; CELLS],
        energy: vec![0; CELLS],
    };
    let mut hash = 1;
    for _ in 0..FIRST {
        hash = pcg(hash);
        if !first.is_set[hash as usize % CELLS] {
            first.put(hash as usize % CELLS, true);
        }
    }
    // Each swap makes the pattern more even, until the tightest cluster is also the largest void. The number of swaps is
    // limited, since ties could lead to an endless loop.
    for _ in 0..CELLS {
        let cluster = first.tightest_cluster();
        first.put(cluster, false);
        let void = first.largest_void();
        first.put(void, true);
        if void == cluster {
            break;
        }
    }
    let count = first.is_set.iter().filter(|is_set| **is_set).count();
    let mut ranks = vec![0_u16; CELLS];
    let mut left = first.clone();
    for rank in (0..count).rev() {
        let cluster = left.tightest_cluster();
        left.put(cluster, false);
        ranks[cluster] = rank as u16;
    }
    // When more than half of the pixels are set, the method looks for the tightest cluster of clear pixels. The energies of
    // set and clear pixels add up to the same sum everywhere, so this is also the largest void.
    for rank in count..CELLS {
        let void = first.largest_void();
        first.put(void, true);
        ranks[void] = rank as u16;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_threshold_occurs_once_in_the_tile() {
        let mut sorted = tile().to_vec();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..CELLS as u16));
    }

    /// Returns the power of a pattern of zeros and ones at each frequency except 0, relative to the mean of white noise,
    /// with the frequency in cycles per tile.
    fn spectrum(ones: &[bool]) -> Vec<(f64, f64)> {
        let share = ones.iter().filter(|one| **one).count() as f64 / CELLS as f64;
        let turns: Vec<(f64, f64)> = (0..SIDE)
            .map(|turn| (turn as f64 / SIDE as f64 * std::f64::consts::TAU).sin_cos())
            .collect();
        let of = |frequency: usize| {
            let (u, v) = (frequency % SIDE, frequency / SIDE);
            let set = (0..CELLS).filter(|cell| ones[*cell]);
            let (im, re) = set.fold((0.0, 0.0), |(im, re), cell| {
                let (sin, cos) = turns[(cell % SIDE * u + cell / SIDE * v) % SIDE];
                (im + sin, re + cos)
            });
            let cycles = |at: usize| at.min(SIDE - at) as f64;
            let power = (re * re + im * im) / (CELLS as f64 * share * (1.0 - share));
            (cycles(u).hypot(cycles(v)), power)
        };
        (1..CELLS).map(of).collect()
    }

    /// Returns the mean power up to ten cycles per tile.
    fn low_power(spectrum: &[(f64, f64)]) -> f64 {
        let low: Vec<f64> = spectrum
            .iter()
            .filter(|(cycles, _)| *cycles <= 10.0)
            .map(|(_, power)| *power)
            .collect();
        low.iter().sum::<f64>() / low.len() as f64
    }

    #[test]
    fn the_noise_has_no_low_frequencies_and_no_dominant_one() {
        for (level, most) in [(0.1_f32, 0.1), (0.25, 0.05), (0.5, 0.05), (0.75, 0.05), (0.9, 0.1)] {
            let ones: Vec<bool> = tile()
                .iter()
                .map(|rank| f32::from(*rank) < level * CELLS as f32)
                .collect();
            let spectrum = spectrum(&ones);
            let low = low_power(&spectrum);
            assert!(low < most, "{level}: {low}");
            // The strongest frequency of white noise has about 10. A regular pattern has all its power in few frequencies.
            let strongest = spectrum.iter().map(|(_, power)| *power).fold(0.0, f64::max);
            assert!(strongest < 20.0, "{level}: {strongest}");
        }
        let white: Vec<bool> = (0..CELLS as u32).map(|cell| pcg(cell) & 1 == 1).collect();
        assert!(low_power(&spectrum(&white)) > 0.5, "what is measured");
    }

    #[test]
    fn channels_and_seeds_have_different_arrangements() {
        let patterns = [
            DitherPattern::new(0, "roughness", 0),
            DitherPattern::new(1, "roughness", 0),
            DitherPattern::new(0, "metallic", 0),
            DitherPattern::new(0, "roughness", 1),
        ];
        for (at, one) in patterns.iter().enumerate() {
            for other in &patterns[..at] {
                let all = (0..CELLS as u32).map(|cell| (cell % 64, cell / 64));
                let both = all.map(|(x, y)| [one, other].map(|pattern| f64::from(pattern.threshold(x, y)) - 0.5));
                let correlation = both.map(|[a, b]| a * b * 12.0).sum::<f64>() / CELLS as f64;
                assert!(correlation.abs() < 0.1, "{correlation}");
            }
        }
    }

    #[test]
    fn thresholds_are_the_same_on_every_machine() {
        let pattern = DitherPattern::new(7, "occlusion", 0);
        let sum = (0..CELLS as u32).fold(0, |hash, cell| {
            pcg(hash ^ (pattern.threshold(cell % 64, cell / 64) * 4096.0) as u32)
        });
        assert_eq!(sum, 619_916_356);
    }
}
