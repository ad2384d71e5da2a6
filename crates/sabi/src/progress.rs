//! Progress bars, and cancellation by Ctrl-C.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::{io, process, thread};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sabi_engine::{Phase, Progress};

use crate::exit::Exit;
use crate::terminal::Terminal;

/// True once Ctrl-C was pressed.
static CANCELED: AtomicBool = AtomicBool::new(false);

/// Progress bar of the current phase.
pub(crate) struct Bars {
    bar: ProgressBar,
    phase: Mutex<Option<Phase>>,
}

impl Bars {
    /// Installs the handler of Ctrl-C, and shows a bar where standard error is a terminal.
    pub(crate) fn new(terminal: &Terminal) -> Bars {
        listen_for_ctrl_c(*terminal);
        // `indicatif` hides the bar where standard error is not a terminal.
        let target = if terminal.bars() {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(1), target);
        let style = ProgressStyle::with_template("{msg:18} {bar:32} {pos}/{len}");
        // A template that `indicatif` refuses costs the look of the bar only.
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Bars {
            bar,
            phase: Mutex::new(None),
        }
    }

    /// Removes the bar.
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
        // A phase that a panic left locked is still a phase.
        let mut shown = self.phase.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if *shown != Some(phase) {
            *shown = Some(phase);
            self.bar.set_message(phase.label());
        }
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
    }

    fn is_canceled(&self) -> bool {
        is_canceled()
    }
}

/// Returns true once the user has stopped the work.
pub(crate) fn is_canceled() -> bool {
    CANCELED.load(Ordering::Relaxed)
}

/// Cancels the work once standard input ends, which is when the process that started this one has ended or closes it.
pub(crate) fn cancel_when_input_ends() {
    thread::spawn(|| {
        // What it says does not matter, nor why it cannot be read any more.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        CANCELED.store(true, Ordering::Relaxed);
    });
}

/// Installs the handler of Ctrl-C: the first one cancels the work, which removes its unfinished files; the second one ends
/// the process.
pub(crate) fn listen_for_ctrl_c(terminal: Terminal) {
    let listening = ctrlc::set_handler(move || {
        if CANCELED.swap(true, Ordering::Relaxed) {
            process::exit(Exit::Interrupted as i32);
        }
        terminal.note("stopping; press Ctrl-C again to quit at once");
    });
    if let Err(error) = listening {
        // Ctrl-C then ends the process at once; unfinished files are hidden and replace no map.
        tracing::warn!("Ctrl-C cannot be listened for: {error}");
    }
}
