//! Selection of the steps of a piece of work that are printed, so that a log stays short.

use std::time::Duration;

use sabi_engine::phases::Phase;

/// Selects the steps that are printed. The first step of a phase always is.
#[derive(Clone, Debug)]
pub(super) struct PrintPace {
    /// Time after the beginning during which nothing is printed.
    silence: Duration,
    /// Shortest time between two printed steps of a phase.
    interval: Duration,
    /// Smallest part of a phase between two printed steps, in percent.
    percent: usize,
    /// True if the last step of a phase is always printed.
    tells_ends: bool,
    /// Latest printed step of each phase.
    told: Vec<PrintedStep>,
}

#[derive(Clone, Copy, Debug)]
struct PrintedStep {
    phase: Phase,
    done: usize,
    at: Duration,
}

impl PrintPace {
    /// Returns the pace of lines for people: at least a second and a tenth of the phase apart.
    pub(super) const LINES: PrintPace = PrintPace {
        silence: Duration::ZERO,
        interval: Duration::from_secs(1),
        percent: 10,
        tells_ends: false,
        told: Vec::new(),
    };

    /// Returns the pace of lines for people for work that takes longer than a few seconds.
    pub(super) const LINES_OF_LONG_WORK: PrintPace = PrintPace {
        silence: Duration::from_secs(4),
        interval: Duration::from_secs(1),
        percent: 10,
        tells_ends: false,
        told: Vec::new(),
    };

    /// Returns the pace of lines for programs: ten per second, and the end of each phase.
    pub(super) const EVENTS: PrintPace = PrintPace {
        silence: Duration::ZERO,
        interval: Duration::from_millis(100),
        percent: 0,
        tells_ends: true,
        told: Vec::new(),
    };

    /// Returns whether a step is printed; `now` is the time since the beginning.
    pub(super) fn is_due(&mut self, now: Duration, phase: Phase, done: usize, of: usize) -> bool {
        if now < self.silence {
            return false;
        }
        let step = PrintedStep { phase, done, at: now };
        let Some(before) = self.told.iter_mut().find(|told| told.phase == phase) else {
            self.told.push(step);
            return true;
        };
        let is_end = self.tells_ends && done == of;
        let is_later = now.saturating_sub(before.at) >= self.interval;
        // A phase that begins again has fewer steps done than before.
        let is_further = done.abs_diff(before.done).saturating_mul(100) >= of.saturating_mul(self.percent);
        let is_due = done != before.done && (is_end || is_later && is_further);
        if is_due {
            *before = step;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use sabi_engine::phases::Phase;

    use super::PrintPace;

    /// Returns the printed steps of a phase of 100 steps that each take this many milliseconds.
    fn told(mut pace: PrintPace, ms: u64) -> Vec<usize> {
        let is_due = |done: &usize| pace.is_due(Duration::from_millis(ms * *done as u64), Phase::Run, *done, 100);
        (0..=100).filter(is_due).collect()
    }

    #[test]
    fn lines_are_a_second_and_a_tenth_of_the_phase_apart() {
        assert_eq!(told(PrintPace::LINES, 1), [0]);
        assert_eq!(told(PrintPace::LINES, 40), [0, 25, 50, 75, 100]);
        let tenths: Vec<usize> = (0..=10).map(|tenth| tenth * 10).collect();
        assert_eq!(told(PrintPace::LINES, 1000), tenths);
    }

    #[test]
    fn short_work_has_no_lines_unless_they_are_wanted() {
        assert_eq!(told(PrintPace::LINES_OF_LONG_WORK, 30), [0usize; 0]);
        assert_eq!(told(PrintPace::LINES_OF_LONG_WORK, 100), [40, 50, 60, 70, 80, 90, 100]);
    }

    #[test]
    fn events_are_ten_a_second_and_tell_the_end_of_each_phase() {
        assert_eq!(told(PrintPace::EVENTS, 0), [0, 100]);
        assert_eq!(
            told(PrintPace::EVENTS, 30),
            [
                0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 52, 56, 60, 64, 68, 72, 76, 80, 84, 88, 92, 96, 100
            ]
        );
    }

    #[test]
    fn phases_that_alternate_are_told_apart() {
        let mut pace = PrintPace::LINES;
        let mut steps = Vec::new();
        for done in 0..4 {
            for phase in [Phase::Run, Phase::Encode] {
                if pace.is_due(Duration::from_millis(done as u64), phase, done, 4) {
                    steps.push((phase, done));
                }
            }
        }
        assert_eq!(steps, [(Phase::Run, 0), (Phase::Encode, 0)]);
        assert!(!pace.is_due(Duration::from_secs(9), Phase::Run, 0, 4), "nothing new");
        assert!(pace.is_due(Duration::from_secs(9), Phase::Run, 1, 4));
        assert!(
            pace.is_due(Duration::from_secs(19), Phase::Run, 0, 4),
            "it begins again"
        );
    }
}
