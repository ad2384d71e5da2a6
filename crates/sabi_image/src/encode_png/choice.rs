//! Chooses the method of compression with a sample of the image.

use rayon::prelude::*;

use super::filter::PngFilter;
use super::method::{Matches, Method};
use super::rows::{Block, Rows};
use super::strip::Strip;

const METHODS: [Method; 4] = [
    Method::new(PngFilter::Smallest, Matches::Runs),
    Method::new(PngFilter::Off, Matches::Runs),
    Method::new(PngFilter::Smallest, Matches::Any),
    Method::new(PngFilter::Off, Matches::Any),
];
/// Size of a part of the sample in bytes; a part consists of neighboring rows.
const PART_BYTES: usize = 64 * 1024;
/// Maximum number of parts of a sample. They are evenly distributed over the image.
const PARTS: usize = 8;
/// Minimum ratio of image to sample, so that the choice takes little time.
const THINNING: usize = 96;

/// Returns the method that gives the smallest sample; `None` if the compressor fails.
pub(super) fn chosen_method(rows: &Rows<'_>) -> Option<Method> {
    let part_rows = (PART_BYTES / (rows.row_bytes + 1)).clamp(1, rows.height);
    let parts = (rows.height / (part_rows * THINNING)).clamp(1, PARTS);
    let of_part = |part: usize| {
        let first = (rows.height - part_rows) * (2 * part + 1) / (2 * parts);
        costs(&rows.block(first..first + part_rows))
    };
    let of_parts = (0..parts).into_par_iter().map(of_part).collect::<Option<Vec<_>>>()?;
    let of_all = |index: usize| of_parts.iter().map(|costs| costs[index]).sum::<u64>();
    let cheapest = (0..METHODS.len()).min_by_key(|index| of_all(*index))?;
    Some(METHODS[cheapest])
}

/// Returns the cost of rows for each method: their compressed size, increased for a method that takes twice the time.
fn costs(block: &Block<'_>) -> Option<[u64; METHODS.len()]> {
    let mut costs = [0; METHODS.len()];
    for (cost, method) in costs.iter_mut().zip(METHODS) {
        let bytes = Strip::new(block, method)?.deflated.len() as u64;
        *cost = match method.matches {
            Matches::Runs => 32 * bytes,
            Matches::Any => 33 * bytes,
        };
    }
    Some(costs)
}
