//! Waits for the device in steps. Between steps, a cancel is noticed and the locks of the device are free for other
//! threads. Work that does not end is given up.

use std::time::Duration;

use crate::error::GpuError;

/// Time of a step.
pub(crate) const STEP: Duration = Duration::from_millis(100);
/// Number of steps for a slice of a kernel: 20 seconds. If a window shares the device, a slice should take a fourth of a step.
pub(crate) const OF_A_SLICE: u32 = 200;
/// Number of steps for the first use of a kernel, in which software drivers compile it: three minutes.
const OF_COMPILING: u32 = 1800;

/// Conditions under which a wait continues.
#[derive(Clone, Copy)]
pub(crate) struct Patience<'a> {
    is_canceled: &'a dyn Fn() -> bool,
    steps: u32,
    /// True for a wait for a slice. A device can have a smaller number of steps for these waits.
    is_for_slice: bool,
}

impl<'a> Patience<'a> {
    /// Returns the patience for a slice of a kernel.
    pub(crate) fn for_slice(is_canceled: &'a dyn Fn() -> bool) -> Patience<'a> {
        Patience {
            is_canceled,
            steps: OF_A_SLICE,
            is_for_slice: true,
        }
    }

    /// Returns the patience for a driver that compiles a kernel.
    pub(crate) fn for_compiling(is_canceled: &'a dyn Fn() -> bool) -> Patience<'a> {
        Patience {
            is_canceled,
            steps: OF_COMPILING,
            is_for_slice: false,
        }
    }

    /// Returns the patience for the work of a canceled run, which is given up after a short time.
    pub(crate) fn for_a_moment() -> Patience<'a> {
        Patience {
            is_canceled: &|| false,
            steps: 2,
            is_for_slice: false,
        }
    }

    /// Returns the patience for work that cannot be canceled.
    pub(crate) fn endless() -> Patience<'a> {
        Patience {
            is_canceled: &|| false,
            steps: u32::MAX,
            is_for_slice: false,
        }
    }

    /// Returns the same patience, with at most this many steps if it is for a slice.
    pub(crate) fn with_steps_of_a_slice(self, most: u32) -> Patience<'a> {
        let steps = if self.is_for_slice {
            self.steps.min(most)
        } else {
            self.steps
        };
        Patience { steps, ..self }
    }

    /// Calls `wait` with the time of a step until it returns a value, the run is canceled, or no steps are left.
    pub(crate) fn wait<T>(self, mut wait: impl FnMut(Duration) -> Option<T>) -> Result<T, GpuError> {
        for _ in 0..self.steps {
            if let Some(done) = wait(STEP) {
                return Ok(done);
            }
            if (self.is_canceled)() {
                return Err(GpuError::Canceled);
            }
        }
        Err(GpuError::TooLong {
            nodes: Vec::new(),
            seconds: (STEP * self.steps).as_secs(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn a_cancel_is_noticed_after_the_step_in_which_it_comes() {
        let steps = Cell::new(0);
        let is_canceled = || steps.get() == 3;
        let waited: Result<(), GpuError> = Patience::for_slice(&is_canceled).wait(|_| {
            steps.set(steps.get() + 1);
            None
        });
        assert_eq!(waited, Err(GpuError::Canceled));
        assert_eq!(steps.get(), 3);
    }

    #[test]
    fn work_that_does_not_end_is_given_up_with_a_sentence() {
        let steps = Cell::new(Duration::ZERO);
        let waited: Result<(), GpuError> = Patience::for_slice(&|| false).wait(|step| {
            steps.set(steps.get() + step);
            None
        });
        let error = waited.expect_err("it does not end").of_nodes(&["rust".to_owned()]);
        assert_eq!(steps.get(), Duration::from_secs(20));
        assert_eq!(
            error.to_string(),
            "the device was busy with node 'rust' for more than 20 seconds, and the run was stopped"
        );
        assert_eq!(
            error.clone().of_nodes(&["other".to_owned()]),
            error,
            "the first name stays"
        );
    }

    #[test]
    fn a_value_that_comes_in_time_is_returned() {
        let steps = Cell::new(0);
        let waited = Patience::for_slice(&|| false).wait(|_| {
            steps.set(steps.get() + 1);
            (steps.get() == 150).then_some("done")
        });
        assert_eq!(waited, Ok("done"));
    }
}
