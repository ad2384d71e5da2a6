//! Progress as lines of JSON; docs/report.md lists the keys.

use sabi_engine::Phase;
use serde::Serialize;

use crate::exit::Exit;

/// A line of `--progress json`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub(crate) enum Event {
    /// Steps of a phase are done.
    Phase {
        phase: &'static str,
        done: usize,
        of: usize,
    },
    /// The command has ended.
    Done { exit: u8 },
}

impl Event {
    /// `done` of `of` steps of a phase are done.
    pub(crate) fn phase(phase: Phase, done: usize, of: usize) -> Event {
        let phase = phase.name();
        Event::Phase { phase, done, of }
    }

    /// The command has ended with this code.
    pub(crate) fn done(exit: Exit) -> Event {
        Event::Done { exit: exit as u8 }
    }
}
