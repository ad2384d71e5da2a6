//! Precedence of evaluators that share a device. The artist waits for one of them, and the others work while it is idle.

use std::collections::BTreeSet;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum interval for checking whether waiting work is still wanted.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// Order of evaluators that share a device. Between two steps, the work of an evaluator waits while an evaluator of a lower
/// rank, or an older one of the same rank, has work.
#[derive(Clone, Debug, Default)]
pub struct Precedence(Arc<SharedState>);

#[derive(Debug, Default)]
struct SharedState {
    state: Mutex<PrecedenceState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct PrecedenceState {
    /// Evaluators that have work, by rank and age.
    working: BTreeSet<QueuePlace>,
    /// Number of places that have been assigned.
    places: u64,
    /// Time until which all evaluators except those of rank 0 wait.
    held_until: Option<Instant>,
}

/// Rank, and number of the evaluator.
type QueuePlace = (u8, u64);

impl Precedence {
    /// Makes evaluators of all ranks except 0 wait for a while, since the window needs the device.
    pub fn hold(&self, for_time: Duration) {
        self.lock().held_until = Some(Instant::now() + for_time);
    }

    /// Returns the turn of a new evaluator.
    pub(super) fn turn(&self, rank: u8) -> Turn {
        let mut state = self.lock();
        state.places += 1;
        Turn {
            place: (rank, state.places),
            precedence: self.clone(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, PrecedenceState> {
        // Every change of the state is a single assignment, so a panic elsewhere leaves it consistent.
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Turn of one evaluator.
#[derive(Debug)]
pub(super) struct Turn {
    place: QueuePlace,
    precedence: Precedence,
}

impl Turn {
    /// Records that there is work. All evaluators after this one wait for it.
    pub(super) fn begin(&self) {
        self.precedence.lock().working.insert(self.place);
    }

    /// Records that there is no work.
    pub(super) fn end(&self) {
        if self.precedence.lock().working.remove(&self.place) {
            self.precedence.0.changed.notify_all();
        }
    }

    /// Waits until no evaluator before this one has work, or until the work is no longer wanted.
    pub(super) fn wait(&self, is_unwanted: impl Fn() -> bool) {
        loop {
            if is_unwanted() {
                return;
            }
            let state = self.precedence.lock();
            let Some(longest) = state.time_to_wait(self.place) else {
                return;
            };
            drop(self.precedence.0.changed.wait_timeout(state, longest.min(LOOK_AGAIN)));
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        self.end();
    }
}

impl PrecedenceState {
    /// Returns the minimum time that the work of a place has to wait; `None` if it is its turn.
    fn time_to_wait(&self, place: QueuePlace) -> Option<Duration> {
        if self.working.first().is_some_and(|first| *first < place) {
            return Some(LOOK_AGAIN);
        }
        let held = self.held_until.filter(|_| place.0 > 0)?;
        let left = held.saturating_duration_since(Instant::now());
        (!left.is_zero()).then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;

    #[test]
    fn work_waits_for_lower_ranks_and_for_older_work_of_its_own() {
        let precedence = Precedence::default();
        let [window, first, second] = [0, 1, 1].map(|rank| precedence.turn(rank));
        let is_turn_of = |turn: &Turn| precedence.lock().time_to_wait(turn.place).is_none();
        second.begin();
        assert!(is_turn_of(&second));
        first.begin();
        assert!(is_turn_of(&first) && !is_turn_of(&second));
        window.begin();
        assert!(is_turn_of(&window) && !is_turn_of(&first));
        window.end();
        drop(first);
        assert!(is_turn_of(&second), "an evaluator that ended is not waited for");
    }

    #[test]
    fn all_but_the_first_rank_wait_while_the_window_needs_the_device() {
        let precedence = Precedence::default();
        let [window, row] = [0, 1].map(|rank| precedence.turn(rank));
        precedence.hold(Duration::from_secs(60));
        assert_eq!(precedence.lock().time_to_wait(window.place), None);
        assert!(precedence.lock().time_to_wait(row.place) > Some(Duration::from_secs(50)));
        precedence.hold(Duration::ZERO);
        assert_eq!(precedence.lock().time_to_wait(row.place), None);
    }

    #[test]
    fn waiting_ends_with_the_work_before_and_with_the_wish() {
        let precedence = Precedence::default();
        let [window, row] = [0, 1].map(|rank| precedence.turn(rank));
        window.begin();
        row.wait(|| true);
        let has_ended = Arc::new(AtomicBool::new(false));
        let ended = has_ended.clone();
        let ends = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(20));
            ended.store(true, Ordering::SeqCst);
            window.end();
        });
        row.wait(|| false);
        assert!(has_ended.load(Ordering::SeqCst));
        ends.join().expect("no panic");
    }
}
