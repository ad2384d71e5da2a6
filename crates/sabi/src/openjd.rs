//! Lines on standard output that report progress to Open Job Description.

use crate::exit::Failure;
use crate::printable::printable;
use crate::terminal::Terminal;

/// Reports the current step.
pub(crate) fn status(terminal: &Terminal, text: &str) -> Result<(), Failure> {
    line(terminal, "status", text)
}

/// Reports the share that is done, from 0 to 1.
pub(crate) fn progress(terminal: &Terminal, share: f64) -> Result<(), Failure> {
    line(terminal, "progress", &format!("{:.1}", share.clamp(0.0, 1.0) * 100.0))
}

/// Reports the reason of a failure.
pub(crate) fn fail(terminal: &Terminal, text: &str) -> Result<(), Failure> {
    line(terminal, "fail", text)
}

fn line(terminal: &Terminal, kind: &str, text: &str) -> Result<(), Failure> {
    // A line break would end the message and begin another one.
    let text = text.replace('\n', " ");
    terminal.data(&format!("openjd_{kind}: {}\n", printable(&text)))
}
