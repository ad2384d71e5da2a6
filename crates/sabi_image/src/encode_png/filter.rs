//! Filters of rows (PNG specification, 9): each byte is stored as its difference from a prediction.

use super::rows::Block;

/// How the filter of each row is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PngFilter {
    /// No filter, which is best if pixels with few different values repeat.
    Off,
    /// The filter with the smallest sum of differences, the usual heuristic for the best compression (PNG specification, 12.8).
    Smallest,
}

/// Filters by their number in the file. The average filter is not used, since it is never much better than Paeth's.
const NONE: u8 = 0;
const LEFT: u8 = 1;
const UP: u8 = 2;
const PAETH: u8 = 4;

/// Returns the filtered rows, each with the number of its filter in front.
pub(super) fn filter_rows(block: &Block<'_>, filter: PngFilter) -> Vec<u8> {
    let zeros = vec![0; block.row_bytes];
    let rows = block.rows_with_above(&zeros);
    let mut out = Vec::with_capacity(rows.len() * (block.row_bytes + 1));
    let mut trials = [const { Vec::new() }; 3];
    for (row, above) in rows {
        let (number, best) = match filter {
            PngFilter::Off => (NONE, None),
            PngFilter::Smallest => smallest(row, above, block.pixel_bytes, &mut trials),
        };
        out.push(number);
        out.extend_from_slice(best.map_or(row, |index| &trials[index][..]));
    }
    out
}

/// Returns the number of the best filter and the index of its row in `trials`; `None` for the unfiltered row.
fn smallest(row: &[u8], above: &[u8], pixel_bytes: usize, trials: &mut [Vec<u8>; 3]) -> (u8, Option<usize>) {
    let [left, up, paeth] = trials;
    for trial in [&mut *left, &mut *up, &mut *paeth] {
        trial.resize(row.len(), 0);
    }
    let first = pixel_bytes.min(row.len());
    left[..first].copy_from_slice(&row[..first]);
    for ((out, &byte), &before) in left[first..].iter_mut().zip(&row[first..]).zip(row) {
        *out = byte.wrapping_sub(before);
    }
    for ((out, &byte), &over) in up.iter_mut().zip(row).zip(above) {
        *out = byte.wrapping_sub(over);
    }
    paeth[..first].copy_from_slice(&up[..first]);
    let neighbors = row.iter().zip(&above[first..]).zip(above);
    for ((out, &byte), ((&before, &over), &corner)) in paeth[first..].iter_mut().zip(&row[first..]).zip(neighbors) {
        *out = byte.wrapping_sub(paeth_guess(before, over, corner));
    }
    // If two filters are equally good, the lower number is chosen.
    let mut best = (cost(row), NONE, None);
    for (index, (number, trial)) in [(LEFT, &*left), (UP, &*up), (PAETH, &*paeth)].into_iter().enumerate() {
        let cost = cost(trial);
        if cost < best.0 {
            best = (cost, number, Some(index));
        }
    }
    (best.1, best.2)
}

fn paeth_guess(left: u8, over: u8, corner: u8) -> u8 {
    let (a, b, c) = (i16::from(left), i16::from(over), i16::from(corner));
    let (to_left, to_over, to_corner) = ((b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs());
    let over_or_corner = if to_over <= to_corner { over } else { corner };
    if to_left <= to_over && to_left <= to_corner {
        left
    } else {
        over_or_corner
    }
}

fn cost(bytes: &[u8]) -> u64 {
    bytes
        .chunks(4096)
        .map(|part| u64::from(part.iter().map(|&b| u32::from(b.min(b.wrapping_neg()))).sum::<u32>()))
        .sum()
}
