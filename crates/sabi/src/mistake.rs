//! A panic is a mistake in Sabi; its user reads a sentence and gets an exit code.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};

use crate::exit::Exit;

/// Runs the program; a panic anywhere becomes a sentence, and one that gets here the exit code of a mistake.
pub(crate) fn caught(work: impl FnOnce() -> Exit + panic::UnwindSafe) -> Exit {
    panic::set_hook(Box::new(|info| {
        let mut stderr = io::stderr().lock();
        let _ = writeln!(stderr, "error: {}", sentence(info));
        let backtrace = Backtrace::capture();
        if backtrace.status() == BacktraceStatus::Captured {
            let _ = writeln!(stderr, "{backtrace}");
        }
    }));
    panic::catch_unwind(work).unwrap_or(Exit::Mistake)
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
        .map(|at| format!(" ({}, line {})", at.file(), at.line()))
        .unwrap_or_default();
    format!("Sabi made a mistake: {what}{place}; please report it with the command you ran")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_exit_code() {
        assert_eq!(caught(|| panic!("this test panics on purpose")), Exit::Mistake);
        assert_eq!(caught(|| Exit::BadInput), Exit::BadInput);
        let _ = panic::take_hook();
    }
}
