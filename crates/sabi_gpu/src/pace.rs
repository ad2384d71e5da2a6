//! Times that kernels take. Kernels that are known to be quick are submitted without waiting for each of them: if a window
//! shares the queue, every wait may last as long as one of its frames.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A kernel is submitted without a wait only if its expected time is at most the target time divided by this number: other
/// parameter values may make its loops longer than they were when it was measured.
pub(crate) const MARGIN: f64 = 8.0;

/// Maximum number of tiles of the first slice of a kernel.
const MOST_FIRST_TILES: u32 = 512;
/// Number of operations that a slow device performs in a few milliseconds.
const FIRST_WORK: u64 = 1 << 24;
/// Texels of a tile.
const TILE_TEXELS: u64 = 64;

/// Time that a kernel takes for one tile, as measured last.
#[derive(Debug)]
pub(crate) struct Pace {
    /// Bits of the time in seconds; 0 while it is unknown.
    seconds: AtomicU64,
    /// Tiles of its first slice.
    first_tiles: u32,
}

/// The default is for Sabi's own kernels, which are quick.
impl Default for Pace {
    fn default() -> Pace {
        Pace {
            seconds: AtomicU64::new(0),
            first_tiles: MOST_FIRST_TILES,
        }
    }
}

impl Pace {
    /// Returns the pace of a kernel that takes up to `work` operations for a texel and has not been measured yet.
    pub(crate) fn of_work(work: u64) -> Pace {
        let of_tile = work.saturating_mul(TILE_TEXELS).max(1);
        let tiles = (FIRST_WORK / of_tile).clamp(1, u64::from(MOST_FIRST_TILES));
        Pace {
            first_tiles: tiles as u32,
            ..Pace::default()
        }
    }

    /// Returns the number of tiles of the first slice: one for an unmeasured kernel that may take long.
    pub(crate) fn first_tiles(&self) -> u32 {
        self.first_tiles
    }

    /// Returns the seconds that a number of tiles take; `None` if the kernel has not been measured yet.
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
        // A time of zero is stored as the smallest positive number, since 0 means unknown.
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
    /// Expected time of all these kernels, in seconds.
    seconds: f64,
    kernels: Vec<Arc<Pace>>,
}

impl InFlight {
    /// Adds a kernel if its time is known and the device is expected to finish all submitted kernels within `target`.
    /// Returns the expected time of the kernel.
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

    /// Returns true if all submitted kernels have been waited for.
    pub(crate) fn is_empty(&self) -> bool {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.kernels.is_empty()
    }

    /// Calls `wait`, which waits for the device, and corrects the times of the kernels if they took less or more time than expected.
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

/// Returns the factor by which to correct times whose expected sum was `seconds`. The device took at most `elapsed`, the
/// time since the first submission, and at least `waited`, the part of it that was spent waiting.
fn correction(seconds: f64, elapsed: Duration, waited: Duration) -> f64 {
    let (most, least) = (elapsed.as_secs_f64(), waited.as_secs_f64());
    // Limits the effect of one unusual time, for example of a wait for a frame of the window.
    (seconds.clamp(least.min(most), most) / seconds.max(f64::MIN_POSITIVE)).clamp(0.5, 8.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    #[test]
    fn the_first_slice_is_one_tile_if_a_texel_may_take_long() {
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
    fn kernels_of_known_time_are_submitted_until_the_device_has_enough_work() {
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
    fn expected_times_are_corrected_to_between_the_waited_and_the_elapsed_time() {
        for (seconds, elapsed, waited, factor) in [
            // The expected time is possible, so it is not corrected.
            (0.010, 20, 5, 1.0),
            (0.010, 8, 5, 0.8),
            (0.010, 60, 40, 4.0),
            // One unusual time has a limited effect.
            (0.010, 1, 0, 0.5),
            (0.001, 900, 900, 8.0),
        ] {
            let found = correction(seconds, elapsed * MILLISECOND, waited * MILLISECOND);
            assert!((found - factor).abs() < 1e-9, "{seconds} {elapsed} {waited}: {found}");
        }
    }
}
