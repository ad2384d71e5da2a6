//! Progress as bars, lines or events.

mod pace;

use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sabi_engine::phases::{Phase, Progress};

use pace::Pace;

use crate::arguments::ProgressChoice;
use crate::event::Event;
use crate::openjd;
use crate::stopping::{is_canceled, listen_for_signals};
use crate::terminal::Terminal;

/// Progress of a command, shown on standard error.
pub(crate) struct ShownProgress {
    terminal: Terminal,
    display: Display,
    started: Instant,
}

/// Form in which progress is shown.
enum Display {
    /// Bar of the current phase.
    Bar(ProgressBar),
    /// Lines for people.
    Lines(Mutex<Pace>),
    /// Lines for programs.
    Events(Mutex<Pace>),
    /// Lines for Open Job Description.
    Statuses(Mutex<Pace>),
    None,
}

impl ShownProgress {
    /// Starts to listen for Ctrl-C and to show progress.
    pub(crate) fn new(terminal: &Terminal) -> ShownProgress {
        listen_for_signals(*terminal);
        ShownProgress {
            terminal: *terminal,
            display: Display::new(terminal.progress(), io::stderr().is_terminal()),
            started: Instant::now(),
        }
    }
}

impl Display {
    fn new(choice: ProgressChoice, is_terminal: bool) -> Display {
        match choice {
            ProgressChoice::Auto if is_terminal => Display::Bar(bar()),
            ProgressChoice::Auto => Display::Lines(Mutex::new(Pace::LINES_OF_LONG_WORK)),
            ProgressChoice::Plain => Display::Lines(Mutex::new(Pace::LINES)),
            ProgressChoice::Json => Display::Events(Mutex::new(Pace::EVENTS)),
            ProgressChoice::Openjd => Display::Statuses(Mutex::new(Pace::LINES)),
            ProgressChoice::None => Display::None,
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
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

impl Progress for ShownProgress {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        tracing::debug!(phase = phase.label(), done, of);
        // The pace is usable even if a thread panicked while it held the lock.
        let is_due = |pace: &Mutex<Pace>| {
            let mut pace = pace.lock().unwrap_or_else(PoisonError::into_inner);
            pace.is_due(self.started.elapsed(), phase, done, of)
        };
        match &self.display {
            Display::Bar(bar) => {
                bar.set_message(phase.label());
                bar.set_length(of as u64);
                bar.set_position(done as u64);
            }
            Display::Lines(pace) if is_due(pace) => {
                self.terminal.line(format_args!("{} {done}/{of}", phase.label()));
            }
            Display::Events(pace) if is_due(pace) => self.terminal.event(&Event::phase(phase, done, of)),
            Display::Statuses(pace) if is_due(pace) => {
                // A closed stream has no reader, so a failure does not matter.
                let _ = openjd::status(&self.terminal, &format!("{} {done}/{of}", phase.label()));
            }
            Display::Lines(_) | Display::Events(_) | Display::Statuses(_) | Display::None => {}
        }
    }

    fn is_canceled(&self) -> bool {
        is_canceled()
    }

    fn waits(&self, sentence: &str) {
        self.terminal.note(sentence);
    }
}
