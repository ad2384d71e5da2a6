//! Padding outside of the charts: the nearest covered pixel, determined once for a texture set and used for every channel.

use std::iter;

use rayon::prelude::*;

use crate::layout::{Cover, NONE, SetLayout};
use crate::{Channel, ChannelPixels};

/// Distance over which padding extends the charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Padding {
    /// Number of texels, Euclidean; pixels further away have the channel's neutral value.
    Texels(u32),
    /// The whole picture, so that no mip level contains an empty texel.
    #[default]
    Infinite,
}

/// For each pixel of a texture set, the pixel that provides its value: the pixel itself if a chart or ring covers it,
/// otherwise the nearest covered one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaddingMap {
    pixels: usize,
    /// A bit for each pixel, row by row from the top: set where it is covered.
    is_covered: Vec<u64>,
    /// Source of each pixel that is not covered, or [`NONE`].
    of_others: Vec<u32>,
    /// Number of uncovered pixels before each part.
    parts: Vec<usize>,
}

/// Pixels of one parallel task.
pub(crate) const PART: usize = 1 << 14;

impl PaddingMap {
    /// Finds the exact nearest covered pixel by Euclidean distance, in two passes in integers (Meijster 2000). Of pixels
    /// equally near, the left column is taken, and in a column the upper one.
    pub fn new(layout: &SetLayout, padding: Padding) -> PaddingMap {
        let size = layout.size as usize;
        let nearest_row = nearest_in_column(size, &layout.cover);
        let reach_squared = match padding {
            Padding::Infinite => i64::MAX,
            Padding::Texels(texels) => i64::from(texels) * i64::from(texels),
        };
        let mut source = vec![NONE; size * size];
        source
            .par_chunks_mut(size.max(1))
            .enumerate()
            .for_each_init(Vec::new, |envelope, (y, row)| {
                let rows = &nearest_row[y * size..(y + 1) * size];
                // Many rows are completely covered and need no search.
                if layout.cover[y * size..(y + 1) * size]
                    .iter()
                    .all(|&cover| cover != Cover::Empty)
                {
                    for (x, pixel) in row.iter_mut().enumerate() {
                        *pixel = (y * size + x) as u32;
                    }
                } else {
                    nearest_in_row(y, rows, reach_squared, envelope, row);
                }
            });
        PaddingMap::of_sources(&source)
    }

    /// Keeps only the sources of pixels that have another pixel as their source.
    fn of_sources(source: &[u32]) -> PaddingMap {
        let is_own = |(pixel, from): (usize, &u32)| pixel == *from as usize;
        let bits = |(word, sources): (usize, &[u32])| {
            let own = sources
                .iter()
                .enumerate()
                .map(|(bit, from)| (bit, is_own((64 * word + bit, from))));
            own.fold(0, |bits, (bit, is_own)| bits | u64::from(is_own) << bit)
        };
        let others = |(part, sources): (usize, &[u32])| {
            let pixels = sources.iter().enumerate().map(|(at, from)| (PART * part + at, from));
            pixels.filter(|pixel| !is_own(*pixel)).count()
        };
        let counts: Vec<usize> = source.par_chunks(PART).enumerate().map(others).collect();
        let mut of_others = Vec::with_capacity(counts.iter().sum());
        of_others.extend(
            source
                .iter()
                .enumerate()
                .filter(|pixel| !is_own(*pixel))
                .map(|(_, from)| from),
        );
        let before = counts.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum - count)
        });
        PaddingMap {
            pixels: source.len(),
            is_covered: source.par_chunks(64).enumerate().map(bits).collect(),
            of_others,
            parts: before.collect(),
        }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.pixels
    }

    /// Source of each pixel, row by row from the top, or [`NONE`].
    pub fn sources(&self) -> impl Iterator<Item = u32> {
        self.sources_from(0)
    }

    /// Sources of the pixels from the first one of a part on.
    pub(crate) fn sources_from(&self, part: usize) -> impl Iterator<Item = u32> {
        let first = self.parts.get(part).copied().unwrap_or(self.of_others.len());
        let mut others = self.of_others[first..].iter();
        (PART * part..self.pixels).map(move |pixel| {
            let is_covered = self.is_covered[pixel / 64] >> (pixel % 64) & 1 == 1;
            let other = if is_covered { None } else { others.next() };
            match (is_covered, other) {
                (true, _) => pixel as u32,
                (false, Some(from)) => *from,
                (false, None) => NONE,
            }
        })
    }

    /// Pixels of a part that are not covered, each with its source.
    fn others(&self, part: usize) -> impl Iterator<Item = (usize, u32)> {
        const WORD: usize = u64::BITS as usize;
        let first = self.parts[part];
        let end = self.pixels.min(PART * (part + 1));
        let words = self.is_covered[PART / WORD * part..end.div_ceil(WORD)]
            .iter()
            .enumerate();
        let pixels = words.flat_map(move |(word, is_covered)| {
            let mut open = !is_covered;
            iter::from_fn(move || {
                let bit = (open != 0).then(|| open.trailing_zeros() as usize)?;
                open &= open - 1;
                Some(PART * part + WORD * word + bit)
            })
        });
        // The last word may contain bits beyond the last pixel.
        pixels
            .take_while(move |pixel| *pixel < end)
            .zip(self.of_others[first..].iter().copied())
    }

    /// Gathers a channel of the set from the atlas: covered pixels are exact copies of their texels, or the mean of those that
    /// share one in a merged layout; padding repeats them.
    ///
    /// `texel` returns the values of an atlas texel, of which the channel's begin at `first`; values beyond them are the
    /// channel's neutral ones.
    pub fn gather(
        &self,
        layout: &SetLayout,
        channel: &Channel,
        first: usize,
        texel: impl Fn(usize) -> [f32; 4] + Sync,
    ) -> ChannelPixels {
        let data = match channel.neutral() {
            [neutral] => self.gathered([*neutral], layout, first, texel),
            [x, y, z] => self.gathered([*x, *y, *z], layout, first, texel),
            _ => Vec::new(),
        };
        ChannelPixels {
            components: channel.components(),
            data,
        }
    }

    fn gathered<const N: usize>(
        &self,
        neutral: [f32; N],
        layout: &SetLayout,
        first: usize,
        texel: impl Fn(usize) -> [f32; 4] + Sync,
    ) -> Vec<f32> {
        let of_texel = |at: usize| {
            let stored = texel(at);
            // A texel has four values; components beyond them are neutral.
            std::array::from_fn(|index| stored.get(first + index).copied().unwrap_or(neutral[index]))
        };
        let mut data = vec![0.0; self.pixels * N];
        data.par_chunks_mut(PART * N).enumerate().for_each(|(part, values)| {
            for (values, pixel) in values.as_chunks_mut::<N>().0.iter_mut().zip(self.sources_from(part)) {
                // A pixel beyond the distance of the padding has `NONE`, which is not an index.
                let from = layout.source.get(pixel as usize).copied().unwrap_or(NONE);
                *values = if from == NONE { neutral } else { of_texel(from as usize) };
            }
        });
        self.share(layout, &mut data, of_texel);
        data
    }

    /// Sets pixels that several texels claim to their mean.
    fn share<const N: usize>(&self, layout: &SetLayout, data: &mut [f32], of_texel: impl Fn(usize) -> [f32; N]) {
        if layout.shared.is_empty() {
            return;
        }
        for (values, pixel) in data.as_chunks_mut::<N>().0.iter_mut().zip(self.sources()) {
            let mut sources = layout.sources(pixel as usize).skip(1).peekable();
            if sources.peek().is_none() {
                continue;
            }
            let mut count = 1.0;
            for from in sources {
                let more = of_texel(from);
                *values = std::array::from_fn(|at| values[at] + more[at]);
                count += 1.0;
            }
            *values = values.map(|sum| sum / count);
        }
    }

    /// Fills the pixels that no chart covers, in a channel laid out as the set is.
    pub fn pad(&self, channel: &Channel, pixels: &mut ChannelPixels) {
        let components = pixels.components.max(1);
        let data = &pixels.data;
        let last = data.len() / components;
        // Sources are covered pixels, which never change.
        let differs = |(to, from): &(usize, u32)| {
            let of = |pixel: usize| data.get(pixel * components..(pixel + 1) * components);
            let source = if *from == NONE {
                Some(channel.neutral())
            } else {
                of(*from as usize)
            };
            // Compare bits, which distinguish −0 from 0.
            let is_same = |(one, other): (&f32, &f32)| one.to_bits() == other.to_bits();
            let is_other = source
                .zip(of(*to))
                .is_some_and(|(one, other)| !one.iter().zip(other).all(is_same));
            *to < last && is_other
        };
        let changed = |part: usize| self.others(part).filter(differs).collect::<Vec<_>>();
        let changed: Vec<Vec<(usize, u32)>> = (0..self.parts.len()).into_par_iter().map(changed).collect();
        for (to, from) in changed.into_iter().flatten() {
            let to = to * components;
            if from == NONE {
                pixels.data[to..to + components].copy_from_slice(channel.neutral());
            } else {
                let from = from as usize * components;
                pixels.data.copy_within(from..from + components, to);
            }
        }
    }
}

/// Returns for each pixel the row of the nearest covered one in its column, of two equally near the upper.
fn nearest_in_column(size: usize, cover: &[Cover]) -> Vec<u32> {
    let mut nearest = vec![NONE; size * size];
    let mut last = vec![NONE; size];
    for y in 0..size {
        for (x, last) in last.iter_mut().enumerate() {
            if cover[y * size + x] != Cover::Empty {
                *last = y as u32;
            }
            nearest[y * size + x] = *last;
        }
    }
    last.fill(NONE);
    for y in (0..size).rev() {
        for (x, last) in last.iter_mut().enumerate() {
            let at = y * size + x;
            if nearest[at] == y as u32 {
                *last = y as u32;
            } else if *last != NONE && (nearest[at] == NONE || *last - (y as u32) < y as u32 - nearest[at]) {
                nearest[at] = *last;
            }
        }
    }
    nearest
}

/// Parabola of a column in the lower envelope, with the first pixel of the row at which it is the lowest.
#[derive(Clone, Copy)]
struct Parabola {
    column: usize,
    height_squared: i64,
    from: i64,
}

fn nearest_in_row(y: usize, nearest_row: &[u32], reach_squared: i64, envelope: &mut Vec<Parabola>, row: &mut [u32]) {
    let size = row.len();
    envelope.clear();
    for (column, &nearest) in nearest_row.iter().enumerate() {
        if nearest == NONE {
            continue;
        }
        let height = i64::from(nearest) - y as i64;
        let height_squared = height * height;
        let mut from = 0;
        while let Some(&top) = envelope.last() {
            // First pixel at which the new column is strictly nearer than the one before it.
            let (i, u) = (top.column as i64, column as i64);
            from = (u * u - i * i + height_squared - top.height_squared).div_euclid(2 * (u - i)) + 1;
            if from > top.from {
                break;
            }
            envelope.pop();
            from = 0;
        }
        if from < size as i64 {
            envelope.push(Parabola {
                column,
                height_squared,
                from,
            });
        }
    }
    let mut parabolas = envelope.iter().peekable();
    let mut current = None;
    for (x, pixel) in row.iter_mut().enumerate() {
        while let Some(parabola) = parabolas.next_if(|parabola| parabola.from <= x as i64) {
            current = Some(parabola);
        }
        let Some(parabola) = current else { break };
        let across = x as i64 - parabola.column as i64;
        if across * across + parabola.height_squared <= reach_squared {
            *pixel = (nearest_row[parabola.column] as usize * size + parabola.column) as u32;
        }
    }
}

#[cfg(test)]
mod tests;
