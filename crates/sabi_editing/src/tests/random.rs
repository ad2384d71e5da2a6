//! Random edits in random order: nothing panics, all edits can be undone and redone, and the resulting graph can be
//! evaluated.

mod actions;
mod kills;
mod split_mix;

use sabi_engine::catalog::Interfaces;
use sabi_graph::UNDO_STEPS;

use super::*;
use actions::RandomActions;
use split_mix::SplitMix64;

/// Total number of random edits, and number of graphs that they are spread over.
const EDITS: usize = 10_000;
const GRAPHS: usize = 25;

impl RandomActions {
    /// Checks the invariants that hold after every edit.
    fn check(&mut self) {
        let text = self.document.session.text().to_owned();
        let read = Document::from_json(&text);
        assert_eq!(read.as_ref(), Ok(self.document.contents()));
        for node in self.ids() {
            assert!(self.document.interface(&node).is_some());
        }
        assert!(
            self.document
                .selection()
                .iter()
                .all(|node| self.document.node(node).is_some())
        );
        let base = self.document.session.graph().base();
        let mut read = |name: &str| self.document.read_group_file(&base, name);
        let (catalog, contents) = (kinds().catalog, Document::from_json(&text).expect("a document"));
        let listed = Interfaces::new(&catalog, &contents, &mut read);
        assert_eq!(
            self.document.interfaces(),
            &listed,
            "what is followed edit by edit is what would be listed anew"
        );
        exposed_knobs::knobs(&self.document);
        for overrides in [Overrides::default(), Overrides::of_preview(self.document.contents())] {
            if let Err(error) = self.document.session.graph().flatten(&overrides) {
                panic!("{error}\n{text}");
            }
        }
    }

    /// Undoes everything, and redoes it.
    fn check_history(&mut self, empty: &str) {
        self.check();
        let after = self.document.session.text().to_owned();
        let steps = self.document.session.undo_names().count();
        assert!(steps < UNDO_STEPS, "all of it can be undone");
        // Check the last step as the editor does; the others need not list ports and knobs.
        for _ in 1..steps {
            self.document.session.undo().expect("a step back");
        }
        history::undo(&mut self.document);
        assert_eq!(self.document.session.undo_names().count(), 0);
        assert_eq!(self.document.session.text(), empty);
        for _ in 1..steps {
            self.document.session.redo().expect("a step forth");
        }
        history::redo(&mut self.document);
        assert_eq!(self.document.session.text(), after);
        self.document.take_notices();
    }
}

#[test]
fn ten_thousand_random_edits_can_be_undone_and_redone() {
    let kinds: Vec<String> = kinds().catalog.entries().map(|entry| entry.id.clone()).collect();
    for graph in 0..GRAPHS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir_all(folder.path().join("deep/er")).expect("a writable folder");
        let session = Session::new(Some(&folder.path().join("kept")));
        let mut actions = RandomActions {
            document: document_with(session, graph as u64),
            dice: SplitMix64(graph as u64),
            clipboard: String::new(),
            kinds: kinds.clone(),
            safe: Vec::new(),
        };
        let empty = actions.document.session.text().to_owned();
        for edit in 1..=EDITS / GRAPHS {
            actions.act(folder.path());
            if edit % 20 == 0 {
                actions.check();
            }
            if edit % (EDITS / GRAPHS / 2) == 0 {
                actions.check_history(&empty);
            }
        }
        actions.document.session.close();
    }
}

#[test]
fn memory_does_not_grow_with_the_number_of_edits() {
    let mut document = document();
    let node = add(&mut document, "noise/white");
    for edit in 0..2 * UNDO_STEPS {
        nodes::set_knob(&mut document, &node, "size", number(edit as f64));
        document.take_notices();
    }
    assert!(document.session.undo_names().count() <= UNDO_STEPS + UNDO_STEPS / 4);
}
