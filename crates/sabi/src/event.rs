//! Progress as lines of JSON; docs/report.md lists the keys.

use sabi_engine::phases::Phase;
use schemars::JsonSchema;
use serde::Serialize;

use crate::exit::Exit;

/// A line of `--progress json`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(tag = "event", rename_all = "snake_case")]
pub(crate) enum Event {
    /// Steps of a phase are done.
    Phase {
        /// Item of a plan, from 0 on.
        #[serde(skip_serializing_if = "Option::is_none")]
        item: Option<usize>,
        /// Name of the phase.
        phase: &'static str,
        /// Steps that are done.
        done: usize,
        /// Steps of the phase.
        of: usize,
    },
    /// An item of a plan has ended.
    Item {
        /// Number in the plan, from 0 on.
        item: usize,
        /// Status after the run.
        status: &'static str,
        /// Requested items that have ended.
        done: usize,
        /// Requested items.
        of: usize,
    },
    /// The command has ended.
    Done {
        /// Exit code of the process.
        exit: u8,
    },
}

impl Event {
    /// Returns the event that `done` of `of` steps of a phase are done.
    pub(crate) fn phase(phase: Phase, done: usize, of: usize) -> Event {
        Event::Phase {
            item: None,
            phase: phase.name(),
            done,
            of,
        }
    }

    /// Returns the event that steps of a phase of an item are done.
    pub(crate) fn phase_of(item: usize, phase: Phase, done: usize, of: usize) -> Event {
        Event::Phase {
            item: Some(item),
            phase: phase.name(),
            done,
            of,
        }
    }

    /// Returns the event that the command has ended with this code.
    pub(crate) fn done(exit: Exit) -> Event {
        Event::Done { exit: exit as u8 }
    }
}
