//! Panics, which are defects of Sabi, as a sentence and an exit code.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};

use crate::exit::Exit;

/// Runs the program. A panic on any thread is printed as a sentence; one on this thread also gives the exit code of a defect.
pub(crate) fn caught(work: impl FnOnce() -> Exit + panic::UnwindSafe) -> Exit {
    panic::set_hook(Box::new(|info| {
        let mut stderr = io::stderr().lock();
        let _ = writeln!(stderr, "error: {}", sentence(info));
        let backtrace = Backtrace::capture();
        if backtrace.status() == BacktraceStatus::Captured {
            let _ = writeln!(stderr, "{backtrace}");
        }
    }));
    // The hook has printed the panic.
    panic::catch_unwind(work).unwrap_or(Exit::Defect)
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
    fn a_panic_becomes_an_exit_code() {
        assert_eq!(caught(|| panic!("this test panics on purpose")), Exit::Defect);
        assert_eq!(caught(|| Exit::BadInput), Exit::BadInput);
        let _ = panic::take_hook();
    }
}
