//! Cancellation of work: by Ctrl-C, by a signal to end, or because the process that started this one has ended.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::time::Duration;
use std::{io, thread};

use crate::exit::Exit;
use crate::terminal::Terminal;

/// True once the work is canceled.
static CANCELED: AtomicBool = AtomicBool::new(false);
/// Exit code of the signal that canceled the work; 0 without a signal.
static SIGNALED: AtomicU8 = AtomicU8::new(0);
static LISTENING: Once = Once::new();
/// Time that the process has to end normally after all results are saved.
#[cfg(feature = "window")]
const MOMENT: Duration = Duration::from_secs(1);

/// Returns true once the work is canceled.
pub(crate) fn is_canceled() -> bool {
    CANCELED.load(Ordering::Relaxed)
}

/// Returns the exit code of a process whose work ends with this code: if a signal canceled the work, the code of the signal.
pub(crate) fn exit_of(exit: Exit) -> Exit {
    match exit {
        Exit::Interrupted if SIGNALED.load(Ordering::Relaxed) == Exit::Terminated as u8 => Exit::Terminated,
        exit => exit,
    }
}

/// Cancels the work once standard input ends: the process that started this one has ended or has closed it.
pub(crate) fn cancel_when_input_ends() {
    thread::spawn(|| {
        // The bytes are ignored, and so is the reason why the input ends.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        CANCELED.store(true, Ordering::Relaxed);
    });
}

/// Handles Ctrl-C and signals to end: the first one cancels the work, which removes its unfinished files; the second one
/// ends the process.
pub(crate) fn listen_for_signals(terminal: Terminal) {
    LISTENING.call_once(|| {
        let listening = listen(move |exit: Exit| {
            SIGNALED.store(exit as u8, Ordering::Relaxed);
            if CANCELED.swap(true, Ordering::Relaxed) {
                end_at_once(exit);
            }
            terminal.note("stopping; press Ctrl-C again to quit at once");
        });
        if let Err(error) = listening {
            // Without a handler, a signal ends the process at once; unfinished files are hidden and do not replace any map.
            tracing::warn!("Ctrl-C cannot be listened for: {error}");
        }
    });
}

/// Ends the process after a short time unless it has ended by then: only a graphics driver can still be at work.
#[cfg(feature = "window")]
pub(crate) fn end_soon() {
    thread::spawn(|| {
        thread::sleep(MOMENT);
        end_at_once(Exit::Done)
    });
}

/// Ends the process when threads of the graphics driver would block its normal end forever.
#[cfg(feature = "window")]
pub(crate) fn end_after_a_loss() {
    let why = "the graphics device was lost and its driver does not come back; what is not saved is offered at the next start";
    tracing::error!("{why}");
    end_at_once(Exit::NoAdapter)
}

/// Ends the process without waiting for its threads: drivers that still compile or compute would delay a normal exit. Files
/// are complete at every moment.
fn end_at_once(exit: Exit) -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(exit as i32);
    #[cfg(not(unix))]
    std::process::exit(exit as i32)
}

#[cfg(unix)]
fn listen(on_signal: impl Fn(Exit) + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM])?;
    thread::spawn(move || {
        for signal in signals.forever() {
            on_signal(match signal {
                SIGTERM => Exit::Terminated,
                _ => Exit::Interrupted,
            });
        }
    });
    Ok(())
}

#[cfg(not(unix))]
fn listen(on_signal: impl Fn(Exit) + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(move || on_signal(Exit::Interrupted)).map_err(io::Error::other)
}
