//! Choice of the method of compression by a sample of the picture.

use rayon::prelude::*;

use super::filter::Filter;
use super::method::{Matches, Method};
use super::rows::{Block, Rows};
use super::strip::Strip;

const METHODS: [Method; 4] = [
    Method::new(Filter::Smallest, Matches::Runs),
    Method::new(Filter::Off, Matches::Runs),
    Method::new(Filter::Smallest, Matches::Any),
    Method::new(Filter::Off, Matches::Any),
];
/// Bytes of neighboring rows in a sample.
const PART_BYTES: usize = 64 * 1024;
/// Parts of a sample at most, evenly over the picture.
const PARTS: usize = 8;
/// Parts of the picture for each part of the sample at least, so that a choice takes little time.
const THINNING: usize = 96;

/// Returns the method that makes a sample of the rows smallest; none if the compressor fails.
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

/// Returns the size of compressed rows for each method. Those of twice the time must be worth it.
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
