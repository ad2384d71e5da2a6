//! Queue between a window and its worker thread.

use std::sync::atomic::AtomicUsize;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use sabi_graph::NodeRef;

use super::event::LiveEvent;
use super::precedence::Turn;
use super::request::{LiveOptions, LiveRequest, ViewSubject};
use crate::phases::{Phase, Progress, SharedActivity};

/// Request with the time of its submission.
pub(super) type SubmittedRequest = (LiveRequest, Instant);

/// Latest request to the worker and pending events to the window.
pub(super) struct WorkerQueue {
    state: Mutex<QueueState>,
    changed: Condvar,
    turn: Turn,
    pub(super) activity: SharedActivity,
    /// Number of threads that compute the shade of a model.
    pub(super) shade_searches: AtomicUsize,
}

#[derive(Default)]
struct QueueState {
    request: Option<SubmittedRequest>,
    events: Vec<LiveEvent>,
    dropped: DroppedPictures,
    is_working: bool,
    is_closed: bool,
}

/// Pictures that the window has dropped.
#[derive(Default)]
pub(super) struct DroppedPictures {
    pub(super) subjects: Vec<ViewSubject>,
    pub(super) thumbnails: Vec<NodeRef>,
}

impl WorkerQueue {
    /// An empty queue of an evaluator with these options.
    pub(super) fn new(options: &LiveOptions) -> WorkerQueue {
        WorkerQueue {
            state: Mutex::default(),
            changed: Condvar::new(),
            turn: options.precedence.turn(options.rank),
            activity: SharedActivity::default(),
            shade_searches: AtomicUsize::new(0),
        }
    }

    /// Replaces the pending request.
    pub(super) fn submit(&self, mut request: LiveRequest) {
        let mut state = self.lock();
        if let Some((pending, _)) = state.request.take() {
            request.graph = pending.graph.followed_by(request.graph);
        }
        state.request = Some((request, Instant::now()));
        if !state.is_closed {
            self.turn.begin();
        }
        drop(state);
        self.changed.notify_one();
    }

    /// Adds pictures that the window has dropped.
    pub(super) fn mark_dropped(&self, dropped: DroppedPictures) {
        let known = &mut self.lock().dropped;
        known.subjects.extend(dropped.subjects);
        known.thumbnails.extend(dropped.thumbnails);
    }

    /// Returns and removes the pictures that the window has dropped since the last call.
    pub(super) fn take_dropped(&self) -> DroppedPictures {
        std::mem::take(&mut self.lock().dropped)
    }

    /// Waits for a request. Returns `None` once the queue is closed.
    pub(super) fn next(&self) -> Option<SubmittedRequest> {
        let mut state = self.lock();
        loop {
            state.is_working = false;
            self.activity.clear();
            if state.is_closed {
                return None;
            }
            if state.request.is_some() {
                drop(state);
                // A newer request may replace it during this wait.
                self.wait_for_turn();
                state = self.lock();
                state.is_working = !state.is_closed;
                return state.request.take().filter(|_| !state.is_closed);
            }
            self.turn.end();
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Ends all work and wakes the worker.
    pub(super) fn close(&self) {
        let mut state = self.lock();
        state.is_closed = true;
        self.turn.end();
        drop(state);
        self.changed.notify_one();
    }

    /// Waits until no evaluator before this one has work. Does not wait after the queue is closed.
    pub(super) fn wait_for_turn(&self) {
        self.turn.wait(|| self.is_closed());
    }

    pub(super) fn is_closed(&self) -> bool {
        self.lock().is_closed
    }

    /// Returns true if the current work is obsolete: a newer request is pending, or the queue is closed.
    pub(super) fn is_superseded(&self) -> bool {
        let state = self.lock();
        state.is_closed || state.request.is_some()
    }

    /// Returns true if loading this model is obsolete: another model is requested, or the queue is closed.
    pub(super) fn is_other_model_requested(&self, model_revision: u64) -> bool {
        let state = self.lock();
        let requested = state.request.as_ref().map(|(request, _)| request.model_revision);
        state.is_closed || requested.is_some_and(|requested| requested != model_revision)
    }

    pub(super) fn is_busy(&self) -> bool {
        let state = self.lock();
        !state.is_closed && (state.is_working || state.request.is_some())
    }

    pub(super) fn send(&self, event: LiveEvent) {
        let mut state = self.lock();
        // A window that has not taken events for a while needs only the newest pictures.
        state.events.retain(|older| !is_outdated(older, &event));
        if matches!(event, LiveEvent::Done { .. } | LiveEvent::Lost(_)) {
            state.is_working = false;
        }
        state.events.push(event);
    }

    pub(super) fn take_events(&self) -> Vec<LiveEvent> {
        std::mem::take(&mut self.lock().events)
    }

    fn lock(&self) -> MutexGuard<'_, QueueState> {
        // Every change of the state is a single assignment or push, so a panic elsewhere leaves it consistent.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns true if a newer event replaces an older one: a picture of the same subject, of an older request.
fn is_outdated(older: &LiveEvent, newer: &LiveEvent) -> bool {
    match (older, newer) {
        (
            LiveEvent::Looks { revision, subject, .. },
            LiveEvent::Looks {
                revision: newer,
                subject: same,
                ..
            },
        ) => revision < newer && subject == same,
        (
            LiveEvent::Thumbnail { revision, node, .. },
            LiveEvent::Thumbnail {
                revision: newer,
                node: same,
                ..
            },
        ) => revision < newer && node == same,
        (LiveEvent::Inspected { revision, .. }, LiveEvent::Inspected { revision: newer, .. }) => revision < newer,
        _ => false,
    }
}

/// Reports the progress of work. Between two of its steps, the work waits for its turn, and is canceled if it is obsolete.
pub(super) struct WorkProgress<'m> {
    pub(super) queue: &'m WorkerQueue,
    /// True if newer requests cancel the work; otherwise only closing the queue does.
    pub(super) is_superseded_by_requests: bool,
}

impl Progress for WorkProgress<'_> {
    fn advance(&self, phase: Phase, done: usize, of: usize) {
        self.queue.activity.set(phase, done, of);
    }

    fn is_canceled(&self) -> bool {
        self.queue.wait_for_turn();
        if self.is_superseded_by_requests {
            self.queue.is_superseded()
        } else {
            self.queue.is_closed()
        }
    }
}
