//! Choice of the method of compression by a sample of the picture.

use rayon::prelude::*;

use super::filter::Filter;
use super::method::{Matches, Method};
use super::rows::Rows;
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
const THINNING: usize = 32;

/// Returns the method that makes a sample of the rows smallest; none if the compressor fails.
pub(super) fn chosen_method(rows: &Rows<'_>) -> Option<Method> {
    let costs = METHODS
        .par_iter()
        .map(|method| cost(*method, rows))
        .collect::<Option<Vec<u64>>>()?;
    METHODS
        .into_iter()
        .zip(costs)
        .min_by_key(|(_, cost)| *cost)
        .map(|(method, _)| method)
}

/// Returns the size of the compressed sample. Methods of twice the time must be worth it.
fn cost(method: Method, rows: &Rows<'_>) -> Option<u64> {
    let part_rows = (PART_BYTES / (rows.row_bytes + 1)).clamp(1, rows.height);
    let parts = (rows.height / (part_rows * THINNING)).clamp(1, PARTS);
    let mut bytes = 0;
    for part in 0..parts {
        let first = (rows.height - part_rows) * (2 * part + 1) / (2 * parts);
        bytes += Strip::new(rows, first..first + part_rows, method)?.deflated.len() as u64;
    }
    Some(match method.matches {
        Matches::Runs => 32 * bytes,
        Matches::Any => 33 * bytes,
    })
}
