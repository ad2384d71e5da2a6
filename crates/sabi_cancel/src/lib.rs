//! Cancelation of long work that computes and cannot fail by itself.
//!
//! Work is run by [`cancelable`], and calls [`look`] now and then. Once it is canceled, [`look`] unwinds the stack to [`cancelable`],
//! as a panic does, but without a message: what the work holds is dropped on the way. So a loop ten functions deep can be left
//! although none of the functions in between takes an argument for it or returns a result.
//!
//! Rules for work that looks: nothing that outlives it may be half changed while it looks, and no lock that others take may be
//! held. Code of other languages must not be between a look and [`cancelable`], since nothing unwinds through that.

use std::any::Any;
use std::cell::RefCell;
use std::io::{BufRead, Read, Result as IoResult, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Items of [`CancelableIterator::looking`] between two looks.
const ITEMS: u32 = 256;

thread_local! {
    /// Request that the work of this thread listens to.
    static CURRENT: RefCell<Cancel> = RefCell::new(Cancel::never());
}

/// Request to cancel work, shared by the work and those who may cancel it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Option<Arc<AtomicBool>>);

/// Outcome of work that was canceled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanceledWork;

impl Cancel {
    /// Creates a request that was not made yet.
    pub fn new() -> Cancel {
        Cancel(Some(Arc::default()))
    }

    /// A request that is never made.
    pub fn never() -> Cancel {
        Cancel(None)
    }

    /// Request that the work of this thread listens to, for other threads that take part in the work.
    pub fn current() -> Cancel {
        CURRENT.with_borrow(Clone::clone)
    }

    /// Returns true unless it is never made.
    pub fn can_be_made(&self) -> bool {
        self.0.is_some()
    }

    /// Makes the request. Does nothing to one that is never made.
    pub fn cancel(&self) {
        if let Some(request) = &self.0 {
            request.store(true, Ordering::Relaxed);
        }
    }

    /// Returns true once the request was made.
    pub fn is_made(&self) -> bool {
        self.0.as_ref().is_some_and(|request| request.load(Ordering::Relaxed))
    }

    /// As [`look`], on any thread that takes part in the work, such as one of a pool.
    pub fn look(&self) {
        if self.is_made() {
            resume_unwind(Box::new(CanceledWork));
        }
    }

    /// Runs a part of the work, which [`look`]s, on any thread that takes part in it. On a thread of a pool, the part must not wait for
    /// that pool: the thread would take up other work meanwhile, which would end with this one.
    pub fn during<T>(&self, work: impl FnOnce() -> T) -> T {
        let _before = OuterCancel(CURRENT.replace(self.clone()));
        work()
    }
}

/// Request that a thread listens to again when this is dropped.
struct OuterCancel(Cancel);

impl Drop for OuterCancel {
    fn drop(&mut self) {
        CURRENT.set(std::mem::take(&mut self.0));
    }
}

/// Runs work on this thread that [`look`]s at a request.
///
/// # Errors
/// The request was made while the work looked. Panics of the work go on.
pub fn cancelable<T>(request: &Cancel, work: impl FnOnce() -> T) -> Result<T, CanceledWork> {
    // Work that looks leaves nothing half changed.
    match catch_unwind(AssertUnwindSafe(|| request.during(work))) {
        Ok(done) => Ok(done),
        Err(payload) if is_canceled(payload.as_ref()) => Err(CanceledWork),
        Err(payload) => resume_unwind(payload),
    }
}

/// Ends the work of this thread if it was canceled; does nothing on a thread whose work is not [`cancelable`].
pub fn look() {
    if CURRENT.with_borrow(Cancel::is_made) {
        resume_unwind(Box::new(CanceledWork));
    }
}

/// Returns true if what was caught ends canceled work, and is no panic.
pub fn is_canceled(payload: &(dyn Any + Send)) -> bool {
    payload.is::<CanceledWork>()
}

/// Iterators over many items, each of which takes little time.
pub trait CancelableIterator: Iterator + Sized {
    /// The same items, with a [`look`] at every few hundredth.
    fn looking(self) -> impl Iterator<Item = Self::Item> {
        let cancel = Cancel::current();
        let mut since = 0;
        self.inspect(move |_| {
            since += 1;
            if since == ITEMS {
                since = 0;
                cancel.look();
            }
        })
    }
}

impl<I: Iterator> CancelableIterator for I {}

/// Reader of a long file that [`look`]s before each piece, so that decoders of other crates do.
#[derive(Debug)]
pub struct LookingReader<R>(pub R);

/// Most bytes that are read at once.
const PIECE_BYTES: usize = 1 << 20;

impl<R: Read> Read for LookingReader<R> {
    fn read(&mut self, into: &mut [u8]) -> IoResult<usize> {
        look();
        let piece = into.len().min(PIECE_BYTES);
        self.0.read(&mut into[..piece])
    }
}

impl<R: BufRead> BufRead for LookingReader<R> {
    fn fill_buf(&mut self) -> IoResult<&[u8]> {
        look();
        let ready = self.0.fill_buf()?;
        Ok(&ready[..ready.len().min(PIECE_BYTES)])
    }

    fn consume(&mut self, bytes: usize) {
        self.0.consume(bytes);
    }
}

impl<R: Seek> Seek for LookingReader<R> {
    fn seek(&mut self, to: SeekFrom) -> IoResult<u64> {
        self.0.seek(to)
    }
}

#[cfg(test)]
mod tests {
    use std::panic::catch_unwind;

    use super::*;

    #[test]
    fn work_that_is_not_canceled_gives_its_result() {
        let request = Cancel::new();
        assert_eq!(cancelable(&request, || (0..10_000).looking().count()), Ok(10_000));
        assert_eq!((0..10_000).looking().count(), 10_000, "without anyone who may cancel");
    }

    #[test]
    fn canceled_work_ends_at_its_next_look_and_drops_what_it_holds() {
        let request = Cancel::new();
        let held = Arc::new(());
        let counted = cancelable(&request, || {
            let _held = held.clone();
            let mut seen = 0;
            for item in (0..1_000_000).looking() {
                seen = item;
                if item == 1000 {
                    request.cancel();
                }
            }
            seen
        });
        assert_eq!(counted, Err(CanceledWork));
        assert_eq!(Arc::strong_count(&held), 1);
        look();
    }

    #[test]
    fn a_request_ends_the_work_that_listens_to_it_alone() {
        let [outer, inner] = [Cancel::new(), Cancel::new()];
        let done = cancelable(&outer, || {
            inner.cancel();
            let within = cancelable(&inner, look);
            look();
            (within, Cancel::current().is_made())
        });
        assert_eq!(done, Ok((Err(CanceledWork), false)));
        Cancel::never().cancel();
        Cancel::never().look();
    }

    #[test]
    fn other_threads_end_canceled_work_through_the_one_that_waits_for_them() {
        let request = Cancel::new();
        let done = cancelable(&request, || {
            let current = Cancel::current();
            request.cancel();
            let thread = std::thread::spawn(move || current.during(look));
            thread.join().unwrap_or_else(|payload| resume_unwind(payload));
        });
        assert_eq!(done, Err(CanceledWork));
    }

    #[test]
    fn a_reader_looks_at_every_piece() {
        let bytes = vec![7; 3 * PIECE_BYTES];
        let request = Cancel::new();
        let mut read = Vec::new();
        let whole = cancelable(&request, || LookingReader(&bytes[..]).read_to_end(&mut read).unwrap());
        assert_eq!((whole, read == bytes), (Ok(bytes.len()), true));
        let stopped = cancelable(&request, || {
            let mut reader = LookingReader(&bytes[..]);
            let first = reader.read(&mut read).unwrap();
            assert_eq!(first, PIECE_BYTES);
            request.cancel();
            reader.read(&mut read)
        });
        assert!(stopped.is_err());
    }

    #[test]
    fn a_panic_of_cancelable_work_goes_on() {
        let panic = catch_unwind(|| cancelable(&Cancel::new(), || panic!("on purpose"))).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"on purpose"));
        assert!(!is_canceled(panic.as_ref()));
    }
}
