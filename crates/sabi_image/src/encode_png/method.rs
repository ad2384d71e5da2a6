//! Method of compression.

use super::filter::PngFilter;

/// Method of compressing an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Method {
    pub(super) filter: PngFilter,
    pub(super) matches: Matches,
}

/// Kind of repetitions that deflate searches for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Matches {
    /// Runs of one byte. Noisy maps, and all maps of 16 bits, have hardly any other repetitions. They are compressed in
    /// half the time and become smaller, since short accidental matches cost more than they save.
    Runs,
    /// Any repetition in the last 32 KiB, as in patterns and flat images.
    Any,
}

impl Method {
    pub(super) const fn new(filter: PngFilter, matches: Matches) -> Method {
        Method { filter, matches }
    }
}
