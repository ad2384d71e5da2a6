//! Limits on the work and the memory of an analysis.
//!
//! A function is analyzed once for each set of whole numbers that it is called with, which are as many as there are ways
//! through the calls: each level of calls can double them.

use std::cell::Cell;

/// Most statements and expressions that one file is analyzed for.
const STEPS: u64 = 1 << 22;
/// Most bytes of what is remembered about calls.
const BYTES: u64 = 16 << 20;

/// Work and memory that are left.
#[derive(Debug)]
pub(super) struct Fuel {
    steps: Cell<u64>,
    bytes: Cell<u64>,
}

impl Fuel {
    pub(super) fn new() -> Fuel {
        Fuel {
            steps: Cell::new(STEPS),
            bytes: Cell::new(BYTES),
        }
    }

    /// Takes this many steps; `false` once there are none left.
    pub(super) fn step(&self, steps: usize) -> bool {
        take(&self.steps, steps)
    }

    /// Takes this many bytes; `false` once there are none left.
    pub(super) fn remember(&self, bytes: usize) -> bool {
        take(&self.bytes, bytes)
    }

    /// Returns true once steps or bytes have run out.
    pub(super) fn is_empty(&self) -> bool {
        self.steps.get() == 0 || self.bytes.get() == 0
    }
}

fn take(from: &Cell<u64>, amount: usize) -> bool {
    from.set(from.get().saturating_sub(amount as u64));
    from.get() > 0
}
