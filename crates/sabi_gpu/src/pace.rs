//! How long kernels take, so that quick ones are submitted one after the other without a wait for each: where a window shares
//! the queue, every wait may last as long as one of its frames.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A kernel is expected to be done in this part of the target time before it is submitted without a wait: other values of its
/// parameters may make its loops longer than they were when it was measured.
pub(crate) const MARGIN: f64 = 8.0;

/// Most tiles of the first slice of a kernel.
const MOST_FIRST_TILES: u32 = 512;
/// Operations that a slow device does in a few milliseconds.
const FIRST_WORK: u64 = 1 << 24;
/// Texels of a tile.
const TILE_TEXELS: u64 = 64;

/// Time that a kernel takes for one tile, as it was measured last.
#[derive(Debug)]
pub(crate) struct Pace {
    /// Bits of the seconds; 0 while they are unknown.
    seconds: AtomicU64,
    /// Tiles of its first slice.
    first_tiles: u32,
}

/// A kernel of Sabi's own, which is quick.
impl Default for Pace {
    fn default() -> Pace {
        Pace {
            seconds: AtomicU64::new(0),
            first_tiles: MOST_FIRST_TILES,
        }
    }
}

impl Pace {
    /// A kernel that takes up to this many operations for a texel, and was not measured yet.
    pub(crate) fn of_work(work: u64) -> Pace {
        let of_tile = work.saturating_mul(TILE_TEXELS).max(1);
        let tiles = (FIRST_WORK / of_tile).clamp(1, u64::from(MOST_FIRST_TILES));
        Pace {
            first_tiles: tiles as u32,
            ..Pace::default()
        }
    }

    /// Tiles of the first slice: one while nothing is known of a kernel but that it may take long.
    pub(crate) fn first_tiles(&self) -> u32 {
        self.first_tiles
    }

    /// Seconds that a number of tiles take; none for a kernel that was not measured yet.
    pub(crate) fn seconds(&self, tiles: u32) -> Option<f64> {
        let seconds = f64::from_bits(self.seconds.load(Ordering::Relaxed));
        (seconds > 0.0).then_some(seconds * f64::from(tiles))
    }

    /// Remembers the time that a number of tiles took.
    pub(crate) fn measured(&self, tiles: u32, taken: Duration) {
        if tiles > 0 {
            self.set(taken.as_secs_f64() / f64::from(tiles));
        }
    }

    fn scale(&self, factor: f64) {
        let seconds = f64::from_bits(self.seconds.load(Ordering::Relaxed));
        self.set(seconds * factor);
    }

    fn set(&self, seconds: f64) {
        // The smallest positive number is a known time, too.
        self.seconds
            .store(seconds.max(f64::MIN_POSITIVE).to_bits(), Ordering::Relaxed);
    }
}

/// Kernels that were submitted to a device without a wait.
#[derive(Debug, Default)]
pub(crate) struct InFlight {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Time of the first submission since the last wait.
    since: Option<Instant>,
    /// Seconds that all of them are expected to take.
    seconds: f64,
    kernels: Vec<Arc<Pace>>,
}

impl InFlight {
    /// Adds a kernel if its time is known, and the device is expected to be done with all of them within `target`. Returns the
    /// time that it is expected to take.
    pub(crate) fn add(&self, pace: &Arc<Pace>, tiles: u32, target: Duration) -> Option<Duration> {
        let seconds = pace.seconds(tiles)?;
        let most = target.as_secs_f64();
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if seconds * MARGIN > most || state.seconds + seconds > most {
            return None;
        }
        state.since.get_or_insert_with(Instant::now);
        state.seconds += seconds;
        state.kernels.push(pace.clone());
        Some(Duration::from_secs_f64(seconds))
    }

    /// Returns true where everything that was submitted was waited for.
    pub(crate) fn is_empty(&self) -> bool {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.kernels.is_empty()
    }

    /// Runs a wait for the device, and corrects the times of the kernels where they took less or more time than expected.
    pub(crate) fn settle<T>(&self, wait: impl FnOnce() -> T) -> T {
        let State {
            since,
            seconds,
            kernels,
        } = std::mem::take(&mut *self.state.lock().unwrap_or_else(PoisonError::into_inner));
        let waiting = Instant::now();
        let waited = wait();
        if let Some(since) = since {
            let factor = correction(seconds, since.elapsed(), waiting.elapsed());
            for pace in kernels {
                pace.scale(factor);
            }
        }
        waited
    }
}

/// Factor for times that were expected to be `seconds` in sum, where the device was done `elapsed` after the submission at the
/// latest, and at the earliest after the `waited` part of it that was spent waiting.
fn correction(seconds: f64, elapsed: Duration, waited: Duration) -> f64 {
    let (most, least) = (elapsed.as_secs_f64(), waited.as_secs_f64());
    // A single odd time, such as that of a wait for a window's frame, does not change much.
    (seconds.clamp(least.min(most), most) / seconds.max(f64::MIN_POSITIVE)).clamp(0.5, 8.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    #[test]
    fn the_first_slice_is_one_tile_where_a_texel_may_take_long() {
        for (work, tiles) in [
            (0, 512),
            (500, 512),
            (1_000, 262),
            (100_000, 2),
            (1 << 24, 1),
            (u64::MAX, 1),
        ] {
            assert_eq!(Pace::of_work(work).first_tiles(), tiles, "{work}");
        }
        assert_eq!(Pace::of_work(u64::MAX).seconds(1), None, "it is not measured yet");
    }

    #[test]
    fn kernels_of_known_time_are_submitted_until_the_device_has_enough_to_do() {
        let (flight, pace) = (InFlight::default(), Arc::new(Pace::default()));
        assert_eq!(flight.add(&pace, 3, 25 * MILLISECOND), None, "its time is unknown");
        pace.measured(100, 100 * MILLISECOND);
        assert_eq!(
            flight.add(&pace, 4, 25 * MILLISECOND),
            None,
            "4 ms are too long for one"
        );
        for _ in 0..8 {
            let expected = flight.add(&pace, 3, 25 * MILLISECOND).expect("room");
            assert!(expected.abs_diff(3 * MILLISECOND) < MILLISECOND / 100, "{expected:?}");
        }
        assert_eq!(
            flight.add(&pace, 3, 25 * MILLISECOND),
            None,
            "27 ms are too long for all"
        );
        flight.settle(|| ());
        assert!(flight.add(&pace, 3, 25 * MILLISECOND).is_some());
    }

    #[test]
    fn a_kernel_that_took_longer_than_expected_is_expected_to_take_longer_again() {
        let (flight, pace) = (InFlight::default(), Arc::new(Pace::default()));
        pace.measured(1, MILLISECOND);
        flight.add(&pace, 1, 25 * MILLISECOND);
        flight.settle(|| std::thread::sleep(4 * MILLISECOND));
        assert!(pace.seconds(1).is_some_and(|seconds| seconds >= 0.004));
    }

    #[test]
    fn times_are_corrected_between_what_was_waited_and_what_has_passed() {
        for (seconds, elapsed, waited, factor) in [
            // In between, nothing is known to be wrong.
            (0.010, 20, 5, 1.0),
            (0.010, 8, 5, 0.8),
            (0.010, 60, 40, 4.0),
            // One time does not change much.
            (0.010, 1, 0, 0.5),
            (0.001, 900, 900, 8.0),
        ] {
            let found = correction(seconds, elapsed * MILLISECOND, waited * MILLISECOND);
            assert!((found - factor).abs() < 1e-9, "{seconds} {elapsed} {waited}: {found}");
        }
    }
}
