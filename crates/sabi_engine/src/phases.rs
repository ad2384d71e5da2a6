//! Phases of a long piece of work: progress, cancelation and times.

use std::panic::resume_unwind;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use sabi_cancel::{Cancel, CanceledWork, cancelable};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use strum::VariantArray;

use crate::error::{EngineError, ErrorKind};

/// Phase of a bake or a rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum Phase {
    /// Reading the graph and the model.
    Load,
    /// Building the linked atlas.
    Atlas,
    /// Uploading the surface and its smaller copies to the device.
    Upload,
    /// Running the plan.
    Run,
    /// Encoding and writing the maps.
    Encode,
    /// Drawing pictures.
    Draw,
}

impl Phase {
    /// All phases.
    pub const ALL: &'static [Phase] = Phase::VARIANTS;

    /// Name in events for programs.
    pub fn name(self) -> &'static str {
        match self {
            Phase::Load => "load",
            Phase::Atlas => "atlas",
            Phase::Upload => "upload",
            Phase::Run => "run",
            Phase::Encode => "encode",
            Phase::Draw => "draw",
        }
    }

    /// Label for progress bars.
    pub fn label(self) -> &'static str {
        match self {
            Phase::Load => "Reading",
            Phase::Atlas => "Preparing UV seams",
            Phase::Upload => "Preparing",
            Phase::Run => "Evaluating",
            Phase::Encode => "Writing maps",
            Phase::Draw => "Drawing",
        }
    }
}

/// Receiver of progress, which can cancel the work.
pub trait Progress: Sync {
    /// Reports that `done` of `of` steps of a phase are done.
    fn advance(&self, phase: Phase, done: usize, of: usize);
    /// Returns true to cancel the work, which then ends with an error of kind `Interrupted`. Called between steps.
    fn is_canceled(&self) -> bool;
    /// Reports, in a sentence, that the work waits for another program. Called once for each wait. The default ignores it.
    fn waits(&self, _sentence: &str) {}
}

/// Progress that is ignored, and never cancels the work.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {
    fn advance(&self, _phase: Phase, _done: usize, _of: usize) {}

    fn is_canceled(&self) -> bool {
        false
    }
}

/// Phase of a piece of work with its steps, and the beginning of the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Activity {
    /// Its phase.
    pub phase: Phase,
    /// Steps of the phase that are done.
    pub done: usize,
    /// Steps of the phase.
    pub of: usize,
    /// Time when the work began, with whatever phase.
    pub since: Instant,
}

impl Activity {
    /// Share of the phase that is done, 0 to 1; `None` for a phase that is a single step.
    pub fn share(&self) -> Option<f32> {
        (self.of > 1).then(|| self.done as f32 / self.of as f32)
    }
}

/// Latest activity of a piece of work, shared between its thread and the thread that shows it.
#[derive(Debug, Default)]
pub struct SharedActivity(Mutex<Option<Activity>>);

impl SharedActivity {
    /// Replaces the activity.
    pub fn set(&self, phase: Phase, done: usize, of: usize) {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *known = Some(Activity {
            phase,
            done,
            of,
            since: known.map_or_else(Instant::now, |activity| activity.since),
        });
    }

    /// Removes the activity, since the work has ended.
    pub fn clear(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Returns the activity; `None` before the work has begun and after its end.
    pub fn get(&self) -> Option<Activity> {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns an error of kind `Interrupted` if the work was canceled.
pub fn stop_if_canceled(progress: &dyn Progress) -> Result<(), EngineError> {
    if progress.is_canceled() {
        return Err(interrupted());
    }
    Ok(())
}

/// Returns the error of work that was canceled.
pub(crate) fn interrupted() -> EngineError {
    EngineError::new(ErrorKind::Interrupted, "stopped; nothing was written")
}

/// Interval for checking whether work was canceled that does not check it itself.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);
/// Stack size of a thread that reads files, the same as that of the first thread of a process.
const STACK_BYTES: usize = 8 << 20;

/// Work that was canceled, or for which there is no thread.
pub(crate) struct StoppedWork {
    pub(crate) error: EngineError,
    /// Thread that is still running and ends at its next check; `None` if none was started.
    pub(crate) left: Option<JoinHandle<()>>,
}

/// Runs work that looks by [`sabi_cancel`] alone, or not at all, such as a reader of another crate, on a thread of its own. Once it
/// is canceled, the thread is left to itself: it ends at the next look, what it holds and takes is limited, and nothing waits for it.
/// Work within such work stays on its thread.
///
/// # Errors
/// The work was canceled, or the system has no thread for it.
pub fn unless_canceled<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, EngineError> {
    if Cancel::current().can_be_made() {
        stop_if_canceled(progress)?;
        return Ok(work());
    }
    unless_left(progress, work).map_err(|stopped| stopped.error)
}

/// As [`unless_canceled`], always on a thread of its own; gives that back where it is left.
pub(crate) fn unless_left<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, StoppedWork> {
    let stopped = |error| StoppedWork { error, left: None };
    stop_if_canceled(progress).map_err(stopped)?;
    let (give, take) = mpsc::channel();
    let cancel = Cancel::new();
    let (span, listened) = (tracing::Span::current(), cancel.clone());
    let started = thread::Builder::new().stack_size(STACK_BYTES).spawn(move || {
        if let Ok(done) = cancelable(&listened, || span.in_scope(work)) {
            // The result of abandoned work is not received.
            let _ = give.send(done);
        }
    });
    let thread = started.map_err(|error| {
        let why = format!("the system has no thread for reading files: {error}; close other programs");
        stopped(EngineError::new(ErrorKind::OutOfMemory, why))
    })?;
    loop {
        match take.recv_timeout(BETWEEN_LOOKS) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = stop_if_canceled(progress) {
                    cancel.cancel();
                    let left = Some(thread);
                    return Err(StoppedWork { error, left });
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                if let Err(panic) = thread.join() {
                    resume_unwind(panic);
                }
                let why = "a thread ended without a result";
                return Err(stopped(EngineError::new(ErrorKind::Defect, why)));
            }
        }
    }
}

/// Runs work on this thread that can be canceled by [`sabi_cancel`], while another thread asks whether it is canceled.
///
/// # Errors
/// The work was canceled.
pub(crate) fn watched<T>(progress: &dyn Progress, work: impl FnOnce() -> T) -> Result<T, CanceledWork> {
    let cancel = Cancel::new();
    let (ends, ended) = mpsc::channel::<()>();
    thread::scope(|scope| {
        let asking = &cancel;
        scope.spawn(move || {
            while ended.recv_timeout(BETWEEN_LOOKS) == Err(RecvTimeoutError::Timeout) {
                if progress.is_canceled() {
                    return asking.cancel();
                }
            }
        });
        let done = cancelable(&cancel, work);
        drop(ends);
        done
    })
}

/// Time spent in one phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTime {
    total: Duration,
}

impl PhaseTime {
    /// Runs `work` and adds its time.
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        self.total += started.elapsed();
        result
    }

    /// Adds time measured elsewhere.
    pub fn add(&mut self, time: Duration) {
        self.total += time;
    }

    /// Sum of all added times.
    pub fn total(&self) -> Duration {
        self.total
    }

    /// Returns milliseconds, rounded to a tenth.
    pub fn ms(&self) -> f64 {
        (self.total.as_secs_f64() * 10_000.0).round() / 10.0
    }
}

impl Serialize for PhaseTime {
    /// Written as milliseconds, rounded to a tenth.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.ms())
    }
}

/// Clock for work that consists of consecutive phases.
#[derive(Debug)]
pub(crate) struct PhaseClock {
    since: Instant,
}

impl PhaseClock {
    /// Starts the first phase.
    pub(crate) fn start() -> PhaseClock {
        PhaseClock { since: Instant::now() }
    }

    /// Ends a phase and starts the next one; returns the time that the phase took.
    pub(crate) fn lap(&mut self) -> Duration {
        let now = Instant::now();
        let taken = now.saturating_duration_since(self.since);
        self.since = now;
        taken
    }
}

/// Time spent in each phase of a bake: `stages_ms` of the report. Their sum is the time that the bake took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct PhaseTimes {
    /// Reading the graph, the model and its images, uploading the surface, and hashing and checking all inputs.
    #[schemars(with = "f64")]
    pub load: PhaseTime,
    /// Building the atlas, or reading it from the cache.
    #[schemars(with = "f64")]
    pub atlas: PhaseTime,
    /// Opening the device, planning, and compiling kernels.
    #[schemars(with = "f64")]
    pub compile: PhaseTime,
    /// Running the plan.
    #[schemars(with = "f64")]
    pub run: PhaseTime,
    /// Normals, readback, padding, encoding and writing.
    #[schemars(with = "f64")]
    pub encode: PhaseTime,
}

impl PhaseTimes {
    /// Adds the time of an evaluation, and the part of it in which kernels were compiled.
    pub(crate) fn add_evaluation(&mut self, taken: Duration, compile: Duration) {
        let compile = compile.min(taken);
        self.compile.add(compile);
        self.run.add(taken - compile);
    }

    /// Sum of all phases.
    pub fn total(&self) -> Duration {
        let phases = [self.load, self.atlas, self.compile, self.run, self.encode];
        phases.iter().map(PhaseTime::total).sum()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Cancels at the third look.
    #[derive(Default)]
    struct Third(AtomicUsize);

    impl Progress for Third {
        fn advance(&self, _: Phase, _: usize, _: usize) {}

        fn is_canceled(&self) -> bool {
            self.0.fetch_add(1, Ordering::Relaxed) >= 2
        }
    }

    #[test]
    fn work_without_checks_is_abandoned_when_it_is_canceled() {
        let (_never, ends) = mpsc::channel::<()>();
        let told = unless_canceled(&Third::default(), move || ends.recv()).unwrap_err();
        assert_eq!(told.kind, ErrorKind::Interrupted);
        assert_eq!(unless_canceled(&NoProgress, || 7).unwrap(), 7);
    }

    #[test]
    fn the_time_of_an_activity_counts_from_the_beginning_of_the_work_over_all_phases() {
        let shared = SharedActivity::default();
        shared.set(Phase::Load, 0, 1);
        let began = shared.get().unwrap().since;
        thread::sleep(Duration::from_millis(2));
        shared.set(Phase::Atlas, 0, 1);
        assert_eq!(shared.get().unwrap().since, began);
        shared.clear();
        shared.set(Phase::Load, 0, 1);
        assert_ne!(shared.get().unwrap().since, began, "other work");
    }

    /// Work that tells when it has begun, and looks until it is canceled.
    fn looking(begun: mpsc::Sender<()>) {
        begun.send(()).unwrap();
        loop {
            sabi_cancel::look();
            thread::yield_now();
        }
    }

    #[test]
    fn the_thread_of_canceled_work_ends_at_its_next_check() {
        let (begun, begins) = mpsc::channel();
        let stopped = unless_left(&Third::default(), move || looking(begun)).unwrap_err();
        assert_eq!(stopped.error.kind, ErrorKind::Interrupted);
        stopped.left.unwrap().join().unwrap();
        begins.recv().unwrap();
    }

    #[test]
    fn nested_work_is_abandoned_together_with_the_outer_work() {
        let (begun, begins) = mpsc::channel();
        let inner = move || {
            let outer = thread::current().id();
            let same = unless_canceled(&NoProgress, move || thread::current().id() == outer).unwrap();
            assert!(same, "one thread is enough");
            unless_canceled(&NoProgress, move || looking(begun))
        };
        let stopped = unless_left(&Third::default(), inner).unwrap_err();
        stopped.left.unwrap().join().unwrap();
        begins.recv().unwrap();
    }

    #[test]
    fn work_that_is_watched_ends_at_its_next_check() {
        let endless = || {
            loop {
                sabi_cancel::look();
                thread::yield_now();
            }
        };
        assert_eq!(watched::<()>(&Third::default(), endless), Err(CanceledWork));
        assert_eq!(watched(&NoProgress, || 7), Ok(7));
    }

    #[test]
    fn a_panic_of_work_on_its_own_thread_reaches_the_caller() {
        let work = || unless_canceled::<()>(&NoProgress, || panic!("on purpose"));
        let panic = std::panic::catch_unwind(work).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"on purpose"));
    }

    #[test]
    fn consecutive_phases_of_a_clock_have_no_gap() {
        let started = Instant::now();
        let mut clock = PhaseClock::start();
        let mut times = PhaseTimes::default();
        times.load.add(clock.lap());
        times.run.add(clock.lap());
        let last = clock.since;
        times.encode.add(clock.lap());
        let until_last = times.load.total() + times.run.total();
        assert!(until_last <= last.saturating_duration_since(started));
        assert_eq!(times.total(), until_last + times.encode.total());
    }
}
