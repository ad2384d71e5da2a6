//! Samples that read each texel.

use super::SeamSample;

/// For each texel beside seams the places that it has in footprints, in the order of the samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FootprintPlaces {
    /// Index of each texel's first place, and the end of the last one.
    starts: Vec<u32>,
    places: Vec<FootprintPlace>,
}

/// Place of a texel in the footprint of one side of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FootprintPlace {
    /// An index into the samples, shifted, above the side and the corner.
    packed: u32,
}

/// Bits of the corner, and of the side above it.
const CORNER_BITS: u32 = 2;
const SIDE_BITS: u32 = 1;

impl FootprintPlace {
    fn new(sample: usize, side: usize, corner: usize) -> FootprintPlace {
        debug_assert!(
            sample < 1 << (u32::BITS - SIDE_BITS - CORNER_BITS),
            "a model has fewer edges"
        );
        FootprintPlace {
            packed: (sample as u32) << (SIDE_BITS + CORNER_BITS) | (side as u32) << CORNER_BITS | corner as u32,
        }
    }

    /// Index of the sample.
    pub(super) fn sample(self) -> usize {
        (self.packed >> (SIDE_BITS + CORNER_BITS)) as usize
    }

    /// Index of the side.
    pub(super) fn side(self) -> usize {
        (self.packed >> CORNER_BITS & ((1 << SIDE_BITS) - 1)) as usize
    }

    /// Index among the four texels of the footprint.
    pub(super) fn corner(self) -> usize {
        (self.packed & ((1 << CORNER_BITS) - 1)) as usize
    }
}

impl FootprintPlaces {
    /// Finds the places of texels, which footprints have as indices below `texels`.
    pub(super) fn new(samples: &[SeamSample], texels: usize) -> FootprintPlaces {
        let read = |sample: &SeamSample| sample.sides.map(|side| side.texels);
        let mut starts = vec![0; texels + 1];
        for texel in samples.iter().flat_map(read).flatten() {
            starts[texel as usize + 1] += 1;
        }
        for texel in 0..texels {
            starts[texel + 1] += starts[texel];
        }
        let mut next = starts.clone();
        let mut places = vec![FootprintPlace::default(); starts[texels] as usize];
        for (index, sample) in samples.iter().enumerate() {
            for (side, footprint) in sample.sides.iter().enumerate() {
                for (corner, texel) in footprint.texels.into_iter().enumerate() {
                    let next = &mut next[texel as usize];
                    places[*next as usize] = FootprintPlace::new(index, side, corner);
                    *next += 1;
                }
            }
        }
        FootprintPlaces { starts, places }
    }

    /// Number of texels.
    pub(super) fn texels(&self) -> usize {
        self.starts.len() - 1
    }

    /// Places of a texel.
    pub(super) fn of(&self, texel: usize) -> &[FootprintPlace] {
        &self.places[self.starts[texel] as usize..self.starts[texel + 1] as usize]
    }
}
