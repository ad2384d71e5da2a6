//! Bars on a terminal, and Ctrl-C.

use std::process;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sabi_engine::{Phase, Progress};

use crate::exit::Exit;
use crate::terminal::Terminal;

/// Whether Ctrl-C was pressed.
static CANCELED: AtomicBool = AtomicBool::new(false);

/// One bar that shows the stage at hand.
pub(crate) struct Bars {
    bar: ProgressBar,
    phase: Mutex<Option<Phase>>,
}

impl Bars {
    /// Starts to listen for Ctrl-C, and shows a bar where standard error is a terminal.
    pub(crate) fn new(terminal: &Terminal) -> Bars {
        listen_for_ctrl_c(*terminal);
        // Hides by itself where standard error is not a terminal.
        let target = if terminal.bars() {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(1), target);
        let style = ProgressStyle::with_template("{msg:18} {bar:32} {pos}/{len}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Bars {
            bar,
            phase: Mutex::new(None),
        }
    }

    /// Takes the bar away, so that words can follow.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Progress for Bars {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        tracing::debug!(phase = phase.label(), done, of);
        let mut shown = self.phase.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if *shown != Some(phase) {
            *shown = Some(phase);
            self.bar.set_message(phase.label());
        }
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
    }

    fn is_canceled(&self) -> bool {
        CANCELED.load(Ordering::Relaxed)
    }
}

/// The first Ctrl-C asks the work to stop, which takes its unfinished files along; the second one does not ask.
fn listen_for_ctrl_c(terminal: Terminal) {
    let listening = ctrlc::set_handler(move || {
        if CANCELED.swap(true, Ordering::Relaxed) {
            process::exit(Exit::Interrupted as i32);
        }
        terminal.note("stopping; press Ctrl-C again to quit at once");
    });
    if let Err(error) = listening {
        // The system's own way of stopping stays; unfinished files are hidden and never take a map's place.
        tracing::warn!("Ctrl-C cannot be listened for: {error}");
    }
}
