//! Method of compression.

use super::filter::Filter;

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

impl Method {
    pub(super) const fn new(filter: Filter, matches: Matches) -> Method {
        Method { filter, matches }
    }
}
