//! Limit for memory that one thread fills and another thread frees.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Number of bytes that may be in use at the same time.
#[derive(Debug)]
pub(super) struct MemoryBudget {
    limit: usize,
    in_use: Mutex<usize>,
    freed: Condvar,
}

/// Share of a budget, returned when dropped.
#[derive(Debug)]
pub(super) struct ReservedMemory<'b> {
    budget: &'b MemoryBudget,
    bytes: usize,
}

impl MemoryBudget {
    pub(super) fn new(limit: usize) -> MemoryBudget {
        MemoryBudget {
            limit,
            in_use: Mutex::new(0),
            freed: Condvar::new(),
        }
    }

    /// Waits until the bytes fit together with all others. More than the limit is granted if nothing else is in use.
    pub(super) fn reserve(&self, bytes: usize) -> ReservedMemory<'_> {
        let is_full = |in_use: &mut usize| *in_use > 0 && in_use.saturating_add(bytes) > self.limit;
        let waited = self.freed.wait_while(self.lock(), is_full);
        *waited.unwrap_or_else(PoisonError::into_inner) += bytes;
        ReservedMemory { budget: self, bytes }
    }

    fn lock(&self) -> MutexGuard<'_, usize> {
        self.in_use.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for ReservedMemory<'_> {
    fn drop(&mut self) {
        *self.budget.lock() -= self.bytes;
        self.budget.freed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;

    use super::MemoryBudget;

    #[test]
    fn bytes_beyond_the_limit_wait_until_others_are_freed() {
        let budget = MemoryBudget::new(10);
        let first = budget.reserve(6);
        let (sender, order) = channel();
        thread::scope(|scope| {
            let budget = &budget;
            let waiting = sender.clone();
            scope.spawn(move || {
                let _second = budget.reserve(6);
                waiting.send("granted").unwrap();
            });
            let _beside = budget.reserve(4);
            sender.send("freed").unwrap();
            drop(first);
        });
        assert_eq!(order.try_iter().collect::<Vec<_>>(), ["freed", "granted"]);
        assert_eq!(*budget.lock(), 0);
    }

    #[test]
    fn one_reservation_may_exceed_the_limit() {
        let budget = MemoryBudget::new(10);
        drop(budget.reserve(1000));
        assert_eq!(*budget.lock(), 0);
    }
}
