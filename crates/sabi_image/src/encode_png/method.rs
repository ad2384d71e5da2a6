//! Choice of the method of compression by a sample of the picture.

use rayon::prelude::*;

use super::filter::Filter;
use super::rows::Rows;
use super::strip::Strip;

/// Method of compressing a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Method {
    pub(super) filter: Filter,
    pub(super) matches: Matches,
}

/// Repeated bytes that deflate looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Matches {
    /// Runs of one byte. Noisy maps, and all of 16 bits, have hardly any others, and are done in half the time and smaller:
    /// short matches by chance cost more than they save.
    Runs,
    /// Any in the last 32 KiB, as patterns and flat pictures have them.
    Any,
}

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

impl Method {
    const fn new(filter: Filter, matches: Matches) -> Method {
        Method { filter, matches }
    }

    /// Returns the method that makes a sample of the rows smallest; none if the compressor fails.
    pub(super) fn of(rows: &Rows<'_>) -> Option<Method> {
        let costs = METHODS
            .par_iter()
            .map(|method| method.cost(rows))
            .collect::<Option<Vec<u64>>>()?;
        METHODS
            .into_iter()
            .zip(costs)
            .min_by_key(|(_, cost)| *cost)
            .map(|(method, _)| method)
    }

    /// Returns the size of the compressed sample. Methods of twice the time must be worth it.
    fn cost(self, rows: &Rows<'_>) -> Option<u64> {
        let part_rows = (PART_BYTES / (rows.row_bytes + 1)).clamp(1, rows.height);
        let parts = (rows.height / (part_rows * THINNING)).clamp(1, PARTS);
        let mut bytes = 0;
        for part in 0..parts {
            let first = (rows.height - part_rows) * (2 * part + 1) / (2 * parts);
            bytes += Strip::new(rows, first..first + part_rows, self)?.deflated.len() as u64;
        }
        Some(match self.matches {
            Matches::Runs => 32 * bytes,
            Matches::Any => 33 * bytes,
        })
    }
}
