//! Limits on the work and the memory of an analysis.
//!
//! A function is analyzed once for each combination of whole numbers that it is called with. There are as many combinations
//! as paths through the calls, and each level of calls can double them.

use std::cell::Cell;

/// Maximum number of statements and expressions that are analyzed for one file.
const STEPS: u64 = 1 << 22;
/// Maximum number of bytes that are kept about calls.
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

    /// Takes this many steps. Returns false if not enough are left.
    pub(super) fn step(&self, steps: usize) -> bool {
        take(&self.steps, steps)
    }

    /// Takes this many bytes. Returns false if not enough are left.
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
