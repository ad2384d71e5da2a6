//! What lies between a window and the thread that works for it.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use sabi_graph::NodeRef;

use super::event::LiveEvent;
use super::request::{LiveRequest, ViewSubject};
use crate::phases::{Phase, Progress};

/// A wish, and when it was made.
pub(super) type Asked = (LiveRequest, Instant);

/// The last wish on its way to the worker, and news on their way to the window.
#[derive(Default)]
pub(super) struct WorkerQueue {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    request: Option<Asked>,
    events: Vec<LiveEvent>,
    forgotten: Forgotten,
    is_working: bool,
    is_closed: bool,
}

/// Pictures that the window had and has let go of.
#[derive(Default)]
pub(super) struct Forgotten {
    pub(super) subjects: Vec<ViewSubject>,
    pub(super) thumbnails: Vec<NodeRef>,
}

impl WorkerQueue {
    /// Puts a wish in the place of the last one.
    pub(super) fn submit(&self, request: LiveRequest) {
        self.lock().request = Some((request, Instant::now()));
        self.changed.notify_one();
    }

    /// Remembers that the window has let go of pictures, until the worker asks.
    pub(super) fn forget(&self, forgotten: Forgotten) {
        let known = &mut self.lock().forgotten;
        known.subjects.extend(forgotten.subjects);
        known.thumbnails.extend(forgotten.thumbnails);
    }

    /// What the window has let go of since the last call.
    pub(super) fn take_forgotten(&self) -> Forgotten {
        std::mem::take(&mut self.lock().forgotten)
    }

    /// Waits for a wish; none once nobody wishes any more.
    pub(super) fn next(&self) -> Option<Asked> {
        let mut state = self.lock();
        loop {
            state.is_working = false;
            if state.is_closed {
                return None;
            }
            if let Some(asked) = state.request.take() {
                state.is_working = true;
                return Some(asked);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Ends all work.
    pub(super) fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_one();
    }

    pub(super) fn is_closed(&self) -> bool {
        self.lock().is_closed
    }

    /// Whether the work at hand is of no use any more.
    pub(super) fn is_superseded(&self) -> bool {
        let state = self.lock();
        state.is_closed || state.request.is_some()
    }

    /// Whether loading this model is of no use any more: another one is wished for, or none.
    fn is_other_wanted(&self, model_revision: u64) -> bool {
        let state = self.lock();
        let wished = state.request.as_ref().map(|(request, _)| request.model_revision);
        state.is_closed || wished.is_some_and(|wished| wished != model_revision)
    }

    pub(super) fn is_busy(&self) -> bool {
        let state = self.lock();
        !state.is_closed && (state.is_working || state.request.is_some())
    }

    pub(super) fn tell(&self, event: LiveEvent) {
        let mut state = self.lock();
        // A window that does not listen for a while wants the newest pictures and none of those before.
        state.events.retain(|older| !is_outdated(older, &event));
        if matches!(event, LiveEvent::Done { .. } | LiveEvent::Lost(_)) {
            state.is_working = false;
        }
        state.events.push(event);
    }

    pub(super) fn take_events(&self) -> Vec<LiveEvent> {
        std::mem::take(&mut self.lock().events)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // What is in it is put in whole, so a panic elsewhere leaves nothing half made.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Whether older news are of no use beside newer ones: pictures of the same thing, of an older wish.
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

/// Stops work that is of no use any more, between two of its steps.
pub(super) struct Watch<'m> {
    pub(super) queue: &'m WorkerQueue,
    /// Whether it is ended by a newer wish, or only when nobody wishes any more.
    pub(super) gives_way: bool,
}

impl Progress for Watch<'_> {
    fn advance(&self, _phase: Phase, _done: usize, _of: usize) {}

    fn is_canceled(&self) -> bool {
        if self.gives_way {
            self.queue.is_superseded()
        } else {
            self.queue.is_closed()
        }
    }
}

/// Stops loading a model that nobody wants any more.
pub(super) struct LoadWatch<'m> {
    pub(super) queue: &'m WorkerQueue,
    pub(super) model_revision: u64,
}

impl Progress for LoadWatch<'_> {
    fn advance(&self, _phase: Phase, _done: usize, _of: usize) {}

    fn is_canceled(&self) -> bool {
        self.queue.is_other_wanted(self.model_revision)
    }
}
