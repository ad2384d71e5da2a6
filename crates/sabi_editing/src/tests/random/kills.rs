//! Random edits of a program that is killed at random moments: what is found then is whole, and nothing is lost that was told as
//! kept or saved.

use std::path::{Path, PathBuf};

use sabi_engine::{Disk, Fault, Remedy, recoveries};

use super::super::*;
use super::actions::Hands;
use super::dice::Dice;

/// Random edits in all, and in how many graphs.
const EDITS: usize = 10_000;
const GRAPHS: usize = 25;
/// Steps of the disk after which the program is killed at the latest.
const MOST_STEPS: usize = 60;
/// Fewest kills that the edits must have met.
const FEWEST_KILLS: usize = 40;

impl Hands {
    /// Saves the graph to some file, or keeps a copy of it. Notes what must be found after a kill.
    pub(super) fn keep(&mut self, folder: &Path) {
        let file = ["a.sabi", "deep/a.sabi", "deep/er/b.sabi"][self.dice.below(3)];
        self.safe.push(self.document.session.text().to_owned());
        let kept = match self.dice.below(4) {
            0 => self.document.save_as(&folder.join(file)),
            // Without a file there is nothing to save to, which it says.
            1 if self.document.session.file().is_none() => return assert!(self.document.save().is_err()),
            1 => self.document.save(),
            _ => self.document.session.keep(&[]).map(drop),
        };
        match kept {
            Ok(()) => self.safe = vec![self.document.session.text().to_owned()],
            // The save of a killed program came after the copy that was recovered; a person is asked, and agrees.
            Err(error) if error.remedies.contains(&Remedy::ReplaceFile) => self.document.session.keep_document(),
            Err(error) => assert!(self.document.session.disk().has_ended(), "{error}"),
        }
    }
}

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

/// Edits a graph in a folder, where the program is killed again and again. Returns the number of kills.
fn edited_with_kills(graph: usize, folder: &Path) -> usize {
    let kept = folder.join("kept");
    let mut session = Session::new(Some(&kept));
    let mut hands = Hands {
        safe: vec![session.text().to_owned()],
        document: document_with(Session::new(None), 0),
        dice: Dice(graph as u64),
        clipboard: String::new(),
        kinds: kinds().1.entries().map(|entry| entry.id.clone()).collect(),
    };
    let (mut edits, mut kills) = (0, 0);
    while edits < EDITS / GRAPHS {
        let disk = Disk::failing(Fault::End, hands.dice.below(MOST_STEPS));
        hands.document = document_with(session.on_disk(&disk), kills as u64);
        while edits < EDITS / GRAPHS && !disk.has_ended() {
            hands.act(folder);
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
    kills
}

#[test]
fn ten_thousand_random_edits_with_kills_in_between_lose_nothing_that_was_told_as_saved() {
    let kills = (0..GRAPHS).map(|graph| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir_all(folder.path().join("deep/er")).expect("a writable folder");
        edited_with_kills(graph, folder.path())
    });
    let kills: usize = kills.sum();
    assert!(kills >= FEWEST_KILLS, "{kills}");
}
