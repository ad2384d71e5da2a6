//! Panics, which are defects of Sabi, as a sentence and an exit code.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};
use std::sync::{Mutex, PoisonError};

use crate::exit::Exit;
use crate::printable::printable;

/// Sentence about the latest panic.
static LATEST: Mutex<String> = Mutex::new(String::new());

/// Runs the program. A panic on any thread is printed as a sentence; one on this thread also gives the sentence as an error.
pub(crate) fn caught(work: impl FnOnce() -> Exit + panic::UnwindSafe) -> Result<Exit, String> {
    panic::set_hook(Box::new(|info| {
        let mut stderr = io::stderr().lock();
        let sentence = sentence(info);
        let _ = writeln!(stderr, "{}", printable(&format!("error: {sentence}")));
        *LATEST.lock().unwrap_or_else(PoisonError::into_inner) = sentence;
        let backtrace = Backtrace::capture();
        if backtrace.status() == BacktraceStatus::Captured {
            let _ = writeln!(stderr, "{backtrace}");
        }
    }));
    // The hook has printed the panic.
    panic::catch_unwind(work).map_err(|_| LATEST.lock().unwrap_or_else(PoisonError::into_inner).clone())
}

fn sentence(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let what = match (payload.downcast_ref::<&str>(), payload.downcast_ref::<String>()) {
        (Some(text), _) => text,
        (_, Some(text)) => text.as_str(),
        _ => "something unknown happened",
    };
    let place = info
        .location()
        .map_or(String::new(), |at| format!(" ({}, line {})", at.file(), at.line()));
    format!("Sabi has a defect: {what}{place}; please report it with the command that you ran")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_sentence() {
        let sentence = caught(|| panic!("this test panics on purpose")).unwrap_err();
        assert!(
            sentence.starts_with("Sabi has a defect: this test panics on purpose ("),
            "{sentence}"
        );
        assert_eq!(caught(|| Exit::BadInput), Ok(Exit::BadInput));
        let _ = panic::take_hook();
    }
}
