//! Progress as bars, lines or events.

mod pace;

use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sabi_engine::phases::{Phase, Progress};

use pace::PrintPace;

use crate::arguments::ProgressChoice;
use crate::event::Event;
use crate::openjd;
use crate::stopping::{is_canceled, listen_for_signals};
use crate::terminal::Terminal;

/// Progress of a command, shown on standard error.
pub(crate) struct ShownProgress {
    terminal: Terminal,
    display: ProgressDisplay,
    started: Instant,
}

/// Form in which progress is shown.
enum ProgressDisplay {
    /// Bar of the current phase.
    Bar(ProgressBar),
    /// Lines for people.
    Lines(Mutex<PrintPace>),
    /// Lines for programs.
    Events(Mutex<PrintPace>),
    /// Lines for Open Job Description.
    Statuses(Mutex<PrintPace>),
    None,
}

impl ShownProgress {
    /// Starts to listen for Ctrl-C and to show progress.
    pub(crate) fn new(terminal: &Terminal) -> ShownProgress {
        listen_for_signals(*terminal);
        ShownProgress {
            terminal: *terminal,
            display: ProgressDisplay::new(terminal.progress(), io::stderr().is_terminal()),
            started: Instant::now(),
        }
    }
}

impl ProgressDisplay {
    fn new(choice: ProgressChoice, is_terminal: bool) -> ProgressDisplay {
        match choice {
            ProgressChoice::Auto if is_terminal => ProgressDisplay::Bar(bar()),
            ProgressChoice::Auto => ProgressDisplay::Lines(Mutex::new(PrintPace::LINES_OF_LONG_WORK)),
            ProgressChoice::Plain => ProgressDisplay::Lines(Mutex::new(PrintPace::LINES)),
            ProgressChoice::Json => ProgressDisplay::Events(Mutex::new(PrintPace::EVENTS)),
            ProgressChoice::Openjd => ProgressDisplay::Statuses(Mutex::new(PrintPace::LINES)),
            ProgressChoice::None => ProgressDisplay::None,
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{msg:18} {bar:32} {pos}/{len}");
    // If `indicatif` refuses the template, the bar only looks different.
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

impl Drop for ShownProgress {
    /// Removes the bar.
    fn drop(&mut self) {
        if let ProgressDisplay::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

impl Progress for ShownProgress {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        tracing::debug!(phase = phase.label(), done, of);
        // The pace is usable even if a thread panicked while it held the lock.
        let is_due = |pace: &Mutex<PrintPace>| {
            let mut pace = pace.lock().unwrap_or_else(PoisonError::into_inner);
            pace.is_due(self.started.elapsed(), phase, done, of)
        };
        match &self.display {
            ProgressDisplay::Bar(bar) => {
                bar.set_message(phase.label());
                bar.set_length(of as u64);
                bar.set_position(done as u64);
            }
            ProgressDisplay::Lines(pace) if is_due(pace) => {
                self.terminal.line(format_args!("{} {done}/{of}", phase.label()));
            }
            ProgressDisplay::Events(pace) if is_due(pace) => self.terminal.event(&Event::phase(phase, done, of)),
            ProgressDisplay::Statuses(pace) if is_due(pace) => {
                // A closed stream has no reader, so a failure does not matter.
                let _ = openjd::status(&self.terminal, &format!("{} {done}/{of}", phase.label()));
            }
            ProgressDisplay::Lines(_)
            | ProgressDisplay::Events(_)
            | ProgressDisplay::Statuses(_)
            | ProgressDisplay::None => {}
        }
    }

    fn is_canceled(&self) -> bool {
        is_canceled()
    }

    fn waits(&self, sentence: &str) {
        self.terminal.note(sentence);
    }
}
