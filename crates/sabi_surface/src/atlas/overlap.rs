//! Charts that overlap in the user's layout, where a map has only one value for all of them.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use sabi_cancel::{Cancel, look};

use super::PAIRS_LIMIT;
use super::build_inputs::ChartSet;
use super::charts::sheet_of;
use super::fixed_point_uvs::{UNIT, Uvs};
use super::mask::{Mask, for_each_run};
use crate::model::Mesh;

/// Maximum number of pairs whose shared texels are counted.
const CANDIDATES_LIMIT: usize = 200_000;

/// Overlap of charts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ChartOverlap {
    /// Owned texels that another chart covers, too.
    pub(super) texels: u64,
    /// Pairs with the number of texels that they share.
    pub(super) pairs: Vec<(u32, u32, u64)>,
    /// Number of charts that coincide with an earlier one.
    pub(super) stacked: u32,
}

/// Texels that a chart claims of a square.
struct ClaimedTexels<'m> {
    chart: usize,
    mask: Cow<'m, Mask>,
}

/// Finds all overlaps within each sheet. UV tiles are wrapped onto one unit square, except those of the sheets in `udims`, each of which
/// has maps of its own.
pub(super) fn overlap(mesh: &Mesh, uvs: &Uvs, charts: &ChartSet, udims: &BTreeSet<u32>, size: u32) -> ChartOverlap {
    let mut found = ChartOverlap::default();
    let numbers: Vec<usize> = (0..charts.partition.len()).collect();
    let sheet = |chart: usize| sheet_of(mesh, charts.partition.triangles(chart));
    for of_sheet in numbers.chunk_by(|&a, &b| sheet(a) == sheet(b)) {
        if of_sheet.len() < 2 {
            continue;
        }
        let is_udim = udims.contains(&sheet(of_sheet[0]));
        let squares = match is_udim {
            true => claims_of_tiles(charts, of_sheet, size),
            false => vec![claims(charts, of_sheet)],
        };
        overlap_of_sheet(uvs, charts, size, &squares, is_udim, &mut found);
    }
    found
}

/// Returns what charts claim of one square onto which all tiles are wrapped.
fn claims<'m>(charts: &'m ChartSet, numbers: &[usize]) -> Vec<ClaimedTexels<'m>> {
    let claim = |&chart: &usize| ClaimedTexels {
        chart,
        mask: Cow::Borrowed(&charts.masks[chart]),
    };
    numbers.iter().map(claim).collect()
}

/// Returns what charts claim of each tile. A texel outside of its chart's tile belongs to the tile that it lies in, or is wrapped where
/// that has no maps, as those of texture sets are.
fn claims_of_tiles<'m>(charts: &'m ChartSet, numbers: &[usize], size: u32) -> Vec<Vec<ClaimedTexels<'m>>> {
    let own = |chart: usize| charts.origins[chart].uv_tile;
    let covering: Vec<usize> = numbers
        .iter()
        .copied()
        .filter(|&chart| !charts.masks[chart].is_empty())
        .collect();
    let mut squares: BTreeMap<[i32; 2], Vec<ClaimedTexels<'m>>> =
        covering.iter().map(|&chart| (own(chart), Vec::new())).collect();
    let tiles: BTreeSet<[i32; 2]> = squares.keys().copied().collect();
    for chart in covering {
        look();
        let home = |tile: [i32; 2]| if tiles.contains(&tile) { tile } else { own(chart) };
        for (tile, mask) in charts.masks[chart].by_tile(size, home) {
            squares.entry(tile).or_default().push(ClaimedTexels { chart, mask });
        }
    }
    squares.into_values().collect()
}

fn overlap_of_sheet(
    uvs: &Uvs,
    charts: &ChartSet,
    size: u32,
    squares: &[Vec<ClaimedTexels<'_>>],
    are_tiles: bool,
    found: &mut ChartOverlap,
) {
    let masks = &charts.masks;
    let mut stacked = BTreeSet::new();
    let mut shared: BTreeMap<[u32; 2], u64> = BTreeMap::new();
    for claims in squares.iter().filter(|claims| claims.len() > 1) {
        let mut square = Square::new(size);
        for claim in claims {
            look();
            square.claim(&WrappedMask::new(&claim.mask, size));
        }
        if square.twice.iter().all(|&word| word == 0) {
            continue;
        }
        let crowded: Vec<(usize, WrappedMask)> = claims
            .iter()
            .map(|claim| (claim.chart, WrappedMask::new(&claim.mask, size)))
            .filter(|(_, wrapped)| square.shared(wrapped) > 0)
            .collect();
        found.texels += crowded.iter().map(|(_, wrapped)| square.shared(wrapped)).sum::<u64>();
        let numbers = crowded.iter().map(|&(chart, _)| chart);
        stacked.extend(coinciding(uvs, charts, size, are_tiles, numbers));
        let room = PAIRS_LIMIT.saturating_sub(found.pairs.len() + shared.len());
        for (a, b, texels) in pairs(&crowded, room) {
            *shared.entry([a, b]).or_default() += texels;
        }
    }
    for ([a, b], texels) in shared {
        // The charts cover the same texels with different triangles.
        if [a, b].iter().all(|&chart| masks[chart as usize].count() == texels) {
            stacked.insert(b as usize);
        }
        found.pairs.push((a, b, texels));
    }
    found.stacked += stacked.len() as u32;
}

/// Returns the pairs of charts that share texels, at most `room` pairs.
fn pairs(crowded: &[(usize, WrappedMask)], room: usize) -> Vec<(u32, u32, u64)> {
    let mut candidates = Vec::new();
    'all: for (index, (_, a)) in crowded.iter().enumerate() {
        look();
        for (other, (_, b)) in crowded.iter().enumerate().skip(index + 1) {
            if a.near(b) {
                candidates.push((index, other));
                if candidates.len() == CANDIDATES_LIMIT {
                    break 'all;
                }
            }
        }
    }
    let cancel = Cancel::current();
    let shared: Vec<u64> = candidates
        .par_iter()
        .inspect(|_| cancel.look())
        .map(|&(a, b)| crowded[a].1.shared(&crowded[b].1))
        .collect();
    let listed = candidates.iter().zip(shared).filter(|&(_, shared)| shared > 0);
    listed
        .map(|(&(a, b), shared)| (crowded[a].0 as u32, crowded[b].0 as u32, shared))
        .take(room)
        .collect()
}

/// Finds charts whose triangles coincide with those of an earlier one, regardless of winding, and of the tile unless each has maps of
/// its own.
fn coinciding(
    uvs: &Uvs,
    charts: &ChartSet,
    size: u32,
    are_tiles: bool,
    numbers: impl Iterator<Item = usize>,
) -> BTreeSet<usize> {
    let mut seen = BTreeSet::new();
    let mut stacked = BTreeSet::new();
    for chart in numbers {
        look();
        let tile = if are_tiles {
            [0; 2]
        } else {
            charts.origins[chart].uv_tile
        };
        let tile = tile.map(|tile| i64::from(tile) * i64::from(size) * UNIT);
        let mut triangles: Vec<[[i64; 2]; 3]> = charts
            .partition
            .triangles(chart)
            .iter()
            .map(|&triangle| {
                let mut corners = uvs
                    .fixed(triangle)
                    .map(|corner| [corner[0] - tile[0], corner[1] - tile[1]]);
                corners.sort_unstable();
                corners
            })
            .collect();
        triangles.sort_unstable();
        let mut hasher = blake3::Hasher::new();
        for value in triangles.iter().flatten().flatten() {
            hasher.update(&value.to_le_bytes());
        }
        if !seen.insert(*hasher.finalize().as_bytes()) {
            stacked.insert(chart);
        }
    }
    stacked
}

/// Unit square of texels with two bits for each texel: covered by a chart, and covered by more than one.
struct Square {
    words: usize,
    once: Vec<u64>,
    twice: Vec<u64>,
}

impl Square {
    fn new(size: u32) -> Square {
        let words = size as usize / 64 + 1;
        let bits = vec![0; words * size as usize];
        Square {
            words,
            once: bits.clone(),
            twice: bits,
        }
    }

    fn claim(&mut self, wrapped: &WrappedMask) {
        for (y, bits) in wrapped.rows() {
            let start = y * self.words + wrapped.first_word;
            let once = &mut self.once[start..start + bits.len()];
            let twice = &mut self.twice[start..start + bits.len()];
            for ((once, twice), bits) in once.iter_mut().zip(twice).zip(bits) {
                *twice |= *once & bits;
                *once |= bits;
            }
        }
    }

    /// Returns the number of texels of a chart that another one covers as well.
    fn shared(&self, wrapped: &WrappedMask) -> u64 {
        let row = |(y, bits): (usize, &[u64])| {
            let twice = &self.twice[y * self.words + wrapped.first_word..];
            twice
                .iter()
                .zip(bits)
                .map(|(twice, bits)| u64::from((twice & bits).count_ones()))
                .sum::<u64>()
        };
        wrapped.rows().map(row).sum()
    }
}

/// A chart's texels wrapped onto the unit square.
struct WrappedMask {
    size: usize,
    /// First row, and number of rows; they wrap from the end of the square to its start.
    top: usize,
    height: usize,
    /// First word of a row, and number of words.
    first_word: usize,
    words: usize,
    bits: Vec<u64>,
}

impl WrappedMask {
    fn new(mask: &Mask, size: u32) -> WrappedMask {
        let size = size as usize;
        let [left, top] = mask.origin.map(|value| value.rem_euclid(size as i64) as usize);
        let (first, last) = match left + mask.width as usize {
            right if right <= size => (left / 64, right / 64),
            _ => (0, size / 64),
        };
        let height = (mask.height as usize).min(size);
        let words = last - first + 1;
        let mut bits = vec![0u64; words * height];
        for (y, row) in mask.rows().enumerate() {
            let target = &mut bits[y % size * words..][..words];
            for_each_run(row, |x0, x1| {
                for x in WrappedRun::new(left + x0, left + x1, size) {
                    set(target, x.start - first * 64, x.end - first * 64);
                }
            });
        }
        WrappedMask {
            size,
            top,
            height,
            first_word: first,
            words,
            bits,
        }
    }

    fn rows(&self) -> impl Iterator<Item = (usize, &[u64])> {
        (0..self.height).map(|y| ((self.top + y) % self.size, &self.bits[y * self.words..][..self.words]))
    }

    /// Returns true if the bounds of two charts overlap, so that the charts may share texels.
    fn near(&self, other: &WrappedMask) -> bool {
        let rows_meet = (other.top + self.size - self.top) % self.size < self.height
            || (self.top + self.size - other.top) % self.size < other.height;
        let (a, b) = (self.first_word, other.first_word);
        rows_meet && a < b + other.words && b < a + self.words
    }

    fn shared(&self, other: &WrappedMask) -> u64 {
        let from = self.first_word.max(other.first_word);
        let to = (self.first_word + self.words).min(other.first_word + other.words);
        let mut shared = 0;
        for (y, bits) in self.rows() {
            let row = (y + other.size - other.top) % other.size;
            if row < other.height {
                let theirs = &other.bits[row * other.words..][..other.words];
                let ours = &bits[from - self.first_word..to - self.first_word];
                let theirs = &theirs[from - other.first_word..to - other.first_word];
                shared += ours
                    .iter()
                    .zip(theirs)
                    .map(|(a, b)| u64::from((a & b).count_ones()))
                    .sum::<u64>();
            }
        }
        shared
    }
}

/// A run of columns, cut at the borders of the unit square.
struct WrappedRun {
    from: usize,
    to: usize,
    size: usize,
}

impl WrappedRun {
    fn new(from: usize, to: usize, size: usize) -> WrappedRun {
        // A run that is as long as the square covers all of it.
        WrappedRun {
            from,
            to: to.min(from + size),
            size,
        }
    }
}

impl Iterator for WrappedRun {
    type Item = std::ops::Range<usize>;

    fn next(&mut self) -> Option<std::ops::Range<usize>> {
        let start = self.from % self.size;
        let length = (self.to - self.from).min(self.size - start);
        self.from += length;
        (length > 0).then_some(start..start + length)
    }
}

fn set(row: &mut [u64], from: usize, to: usize) {
    for (index, word) in row.iter_mut().enumerate().take((to - 1) / 64 + 1).skip(from / 64) {
        let low = from.saturating_sub(index * 64);
        let high = (to - index * 64).min(64);
        *word |= (u64::MAX << low) & (u64::MAX >> (64 - high));
    }
}
