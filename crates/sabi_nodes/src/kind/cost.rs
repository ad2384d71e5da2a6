//! Cost of compiling a node.

/// Estimated time to compile a piece of code, in units of an addition of two numbers. Calls are counted as if they were
/// inlined, and the body of a loop counts once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// All code.
    pub all: u32,
    /// The code outside of loops. Drivers optimize it as a whole, so the time for it grows faster than its length.
    pub straight: u32,
}

impl Cost {
    /// Cost of both together.
    #[must_use]
    pub fn and(self, other: Cost) -> Cost {
        Cost {
            all: self.all.saturating_add(other.all),
            straight: self.straight.saturating_add(other.straight),
        }
    }

    /// Returns true if both parts are within those of a limit.
    pub fn is_within(self, limit: Cost) -> bool {
        self.all <= limit.all && self.straight <= limit.straight
    }
}
