//! Random edits of a program that is killed at random moments: what is found then is whole, and nothing is lost that was told as
//! kept or saved.

use std::path::{Path, PathBuf};

use sabi_engine::{Disk, Fault, recoveries};

use super::super::*;
use super::actions::Hands;
use super::dice::Dice;

/// Random edits in all.
const EDITS: usize = 10_000;
/// Steps of the disk after which the program is killed at the latest.
const MOST_STEPS: usize = 100;
/// Fewest kills that the edits must have met.
const FEWEST_KILLS: usize = 40;

/// Opens what the program left: the copy of unsaved work, or the graph's file where that is what was saved last.
fn reopened(kept: &Path, file: Option<&PathBuf>, safe: &[String]) -> Session {
    if let Some(recovery) = recoveries(kept).pop() {
        let mut session = Session::recover(recovery).expect("a copy that is whole");
        if safe.iter().any(|text| text == session.text()) {
            return session;
        }
        session.close();
    }
    let mut session = match file {
        Some(file) => Session::open(file, Some(kept)).expect("a graph that is whole"),
        None => Session::new(Some(kept)),
    };
    assert!(
        safe.iter().any(|text| text == session.text()),
        "what was told as saved is lost"
    );
    session
}

#[test]
fn ten_thousand_random_edits_with_kills_in_between_lose_nothing_that_was_told_as_saved() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir_all(folder.path().join("deep/er")).expect("a writable folder");
    let kept = folder.path().join("kept");
    let mut session = Session::new(Some(&kept));
    let mut hands = Hands {
        safe: vec![session.text().to_owned()],
        document: document_with(Session::new(None), 0),
        dice: Dice(22),
        clipboard: String::new(),
        kinds: kinds().1.entries().map(|entry| entry.id.clone()).collect(),
    };
    let (mut edits, mut kills) = (0, 0);
    while edits < EDITS {
        let disk = Disk::failing(Fault::End, hands.dice.below(MOST_STEPS));
        hands.document = document_with(session.on_disk(&disk), kills as u64);
        while edits < EDITS && !disk.has_ended() {
            hands.act(folder.path());
            hands.document.take_notices();
            edits += 1;
        }
        kills += usize::from(disk.has_ended());
        let file = hands.document.session.file().map(Path::to_owned);
        // A killed program runs no destructor that writes.
        hands.document = document_with(Session::new(None), 0);
        session = reopened(&kept, file.as_ref(), &hands.safe);
        hands.safe = vec![session.text().to_owned()];
    }
    assert!(kills >= FEWEST_KILLS, "{kills}");
}
