//! Gathers channels from an atlas that is read in bands.

use std::ops::Range;

use rayon::prelude::*;

use crate::layout::{NONE, SetLayout};
use crate::padding::{PART, PaddingMap};
use crate::{Channel, ChannelPixels};

/// For each pixel of a texture set, the atlas texel that provides its value, in an order that allows the atlas to be read
/// in bands of consecutive texels, so that it is never in memory as a whole.
///
/// Only for layouts in which each pixel has one texel. The mean of several texels is gathered by [`PaddingMap::gather`].
#[derive(Debug)]
pub struct BandGather {
    /// For each part of the pixels, the range of texels that provide its values.
    of_parts: Vec<Range<usize>>,
}

impl BandGather {
    /// Finds the range of texels that each part of the pixels needs.
    pub fn new(padding: &PaddingMap, layout: &SetLayout) -> BandGather {
        debug_assert!(layout.shared.is_empty(), "a mean is taken of texels in several bands");
        let range = |part: usize| {
            let texels = padding.sources_from(part).take(PART);
            let texels = texels.filter_map(|pixel| source(layout, pixel));
            around(texels.map(|texel| texel..texel + 1))
        };
        BandGather {
            of_parts: (0..padding.pixels().div_ceil(PART))
                .into_par_iter()
                .map(range)
                .collect(),
        }
    }

    /// Returns the range of texels that contains all that the pixels need; empty if they need none.
    pub fn texels(&self) -> Range<usize> {
        around(self.of_parts.iter().filter(|part| !part.is_empty()).cloned())
    }

    /// Sets the pixels whose texels are in a band. `copy` fills in the values of neighboring texels of the atlas, in which
    /// the values of the channel start at `first`; missing values are the channel's neutral ones.
    pub fn add(
        &self,
        padding: &PaddingMap,
        layout: &SetLayout,
        channel: &Channel,
        pixels: &mut ChannelPixels,
        band: &Range<usize>,
        first: usize,
        copy: impl Fn(Range<usize>, &mut [[f32; 4]]) + Sync,
    ) {
        match channel.neutral() {
            [neutral] => self.add_values(padding, layout, [*neutral], &mut pixels.data, band, first, copy),
            [x, y, z] => self.add_values(padding, layout, [*x, *y, *z], &mut pixels.data, band, first, copy),
            _ => {}
        }
    }

    fn add_values<const N: usize>(
        &self,
        padding: &PaddingMap,
        layout: &SetLayout,
        neutral: [f32; N],
        data: &mut [f32],
        band: &Range<usize>,
        first: usize,
        copy: impl Fn(Range<usize>, &mut [[f32; 4]]) + Sync,
    ) {
        let parts = data.par_chunks_mut(PART * N).zip(&self.of_parts).enumerate();
        parts.for_each(|(part, (values, range))| {
            if range.end <= band.start || range.start >= band.end {
                return;
            }
            let (pixels, _) = values.as_chunks_mut::<N>();
            let mut room = [[0.0; 4]; LONGEST_RUN];
            let mut take = |run: &PixelRun| {
                if run.length == 0 {
                    return;
                }
                let stored = &mut room[..run.length];
                copy(run.texel..run.texel + run.length, stored);
                for (values, stored) in pixels[run.pixel..].iter_mut().zip(stored) {
                    // A texel has four values; components beyond them are neutral.
                    *values = std::array::from_fn(|index| stored.get(first + index).copied().unwrap_or(neutral[index]));
                }
            };
            let mut run = PixelRun::default();
            for (pixel, from) in padding.sources_from(part).take(PART).enumerate() {
                let from = source(layout, from).filter(|from| band.contains(from));
                if !run.extend(pixel, from) {
                    take(&run);
                    run = PixelRun::at(pixel, from);
                }
            }
            take(&run);
        });
    }
}

/// Most texels of a run.
const LONGEST_RUN: usize = 64;

/// Adjacent pixels of a part of a set that take their values from adjacent texels.
#[derive(Clone, Copy, Default)]
struct PixelRun {
    /// The first pixel, and the first texel.
    pixel: usize,
    texel: usize,
    length: usize,
}

impl PixelRun {
    /// Run of a pixel; empty if it has no texel.
    fn at(pixel: usize, texel: Option<usize>) -> PixelRun {
        PixelRun {
            pixel,
            // The default is not read in an empty run.
            texel: texel.unwrap_or_default(),
            length: usize::from(texel.is_some()),
        }
    }

    /// Adds the next pixel if its texel is the next one, or if neither the run nor the pixel has a texel.
    fn extend(&mut self, pixel: usize, texel: Option<usize>) -> bool {
        let Some(texel) = texel else { return self.length == 0 };
        let is_next = self.length > 0
            && self.length < LONGEST_RUN
            && pixel == self.pixel + self.length
            && texel == self.texel + self.length;
        self.length += usize::from(is_next);
        is_next
    }
}

/// Returns the range around some ranges; an empty one if there are none.
fn around(ranges: impl Iterator<Item = Range<usize>>) -> Range<usize> {
    let both = |one: Range<usize>, other: Range<usize>| one.start.min(other.start)..one.end.max(other.end);
    ranges.reduce(both).unwrap_or(0..0)
}

/// Returns the texel that provides the value of a covered pixel; `None` for [`NONE`], which is not an index.
fn source(layout: &SetLayout, pixel: u32) -> Option<usize> {
    let texel = layout.source.get(pixel as usize).copied();
    texel.filter(|texel| *texel != NONE).map(|texel| texel as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::tests::atlas;
    use crate::{Padding, set_keys};

    #[test]
    fn bands_give_the_pixels_that_the_whole_atlas_gives() {
        let atlas = atlas(
            16,
            32,
            &[(0, [0, 0], [0, 0], 1..7, 1..7), (0, [16, 8], [0, 0], 25..30, 17..20)],
        );
        let layout = SetLayout::new(&atlas, set_keys(&atlas)[0]);
        let value = |texel: usize| std::array::from_fn(|at| (4 * texel + at) as f32);
        for padding in [Padding::Infinite, Padding::Texels(2)] {
            let padding = PaddingMap::new(&layout, padding);
            let gather = BandGather::new(&padding, &layout);
            let texels = gather.texels();
            assert!(texels.end < atlas.owners.len(), "{texels:?}");
            for (channel, first) in [(Channel::BaseColor, 0), (Channel::Normal, 2), (Channel::Metallic, 1)] {
                let mut pixels = ChannelPixels::neutral(&channel, layout.source.len());
                for start in (0..atlas.owners.len()).step_by(100) {
                    let band = start..start + 100;
                    gather.add(&padding, &layout, &channel, &mut pixels, &band, first, |texels, out| {
                        assert!(band.start <= texels.start && texels.end <= band.end);
                        assert_eq!(texels.len(), out.len());
                        out.iter_mut().zip(texels).for_each(|(out, texel)| *out = value(texel));
                    });
                }
                assert_eq!(pixels, padding.gather(&layout, &channel, first, value));
            }
        }
    }
}
