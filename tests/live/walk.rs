//! A long walk through graphs leads to what the last of them is on its own.

#[path = "../../crates/sabi_editor/benches/soak/walk.rs"]
mod edits;

use std::sync::Arc;

use edits::{FIRST, Walk, WalkStep};
use sabi_engine::evaluating::ModelLooks;
use sabi_engine::live::{GraphFaults, LiveRequest};
use sabi_graph::History;

use crate::window::{ReceivedEvents, Window, bytes, document, request};

const EDITS: u64 = 200;
/// So many edits are shown to the end; those between are overtaken by others.
const EVERY: u64 = 10;
/// Fewest pictures to compare. A graph at fault has no picture of its own: the previous picture stays on the screen.
const LEAST_COMPARED: usize = 8;

/// Content of a window after the events so far.
#[derive(Default)]
struct WindowContent {
    shown: Option<Arc<ModelLooks>>,
    faults: GraphFaults,
}

impl WindowContent {
    fn take(&mut self, told: &ReceivedEvents) {
        if let Some((.., shown)) = told.shown().last() {
            self.shown = Some(Arc::clone(shown));
        }
        if let Some(faults) = told.faults() {
            self.faults = faults.clone();
        }
    }

    fn answer(&mut self, window: &Window, wished: LiveRequest) {
        self.take(&window.answer(wished));
    }

    fn is_at_fault(&self, node: &str) -> bool {
        let faults = &self.faults;
        faults.faults.iter().any(|fault| fault.node == node)
            || faults.blocked.iter().any(|blocked| blocked.node == node)
    }

    fn bytes(&self) -> Option<Vec<u8>> {
        self.shown.as_deref().map(bytes)
    }
}

#[test]
fn results_after_a_walk_are_those_of_a_fresh_evaluation() {
    let mut open = document(FIRST);
    let (mut history, mut walk) = (History::new(), Walk::new(7));
    let (window, mut screen) = (Window::new(), WindowContent::default());
    let mut compared = 0;
    for revision in 1..=EDITS {
        let document = &mut open.document;
        // Some do not fit, and change nothing.
        let _ = match walk.next(document) {
            WalkStep::Edit(edit) => history.apply(document, "Edit", *edit),
            WalkStep::Undo => history.undo(document).map(drop),
            WalkStep::Redo => history.redo(document).map(drop),
        };
        let wished = request(revision, open.clone());
        if revision % EVERY != 0 {
            window.live.submit(wished);
            continue;
        }
        screen.answer(&window, wished.clone());
        let mut fresh = WindowContent::default();
        fresh.answer(&Window::new(), wished);
        assert_eq!(screen.faults, fresh.faults, "after {revision} edits");
        if screen.is_at_fault("out") {
            continue;
        }
        assert!(
            screen.bytes() == fresh.bytes(),
            "after {revision} edits:\n{}",
            open.document.to_json()
        );
        compared += 1;
    }
    assert!(compared >= LEAST_COMPARED, "{compared}");
}
