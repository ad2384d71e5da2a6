//! Random edits in a program that is killed at random moments. Afterwards the files must be complete, and everything that
//! was reported as saved or kept must be there.

use std::path::{Path, PathBuf};

use sabi_engine::Remedy;
use sabi_engine::session::recoveries;
use sabi_files::{Disk, DiskFault};

use super::super::*;
use super::actions::RandomActions;
use super::split_mix::SplitMix64;

/// Total number of random edits, and number of graphs that they are spread over.
const EDITS: usize = 10_000;
const GRAPHS: usize = 25;
/// Maximum number of disk operations before the program is killed.
const MOST_STEPS: usize = 60;
/// Minimum number of kills in a run, so that the test tests something.
const FEWEST_KILLS: usize = 40;

impl RandomActions {
    /// Saves the graph to some file, or keeps a recovery copy. Notes what must be found after a kill.
    pub(super) fn keep(&mut self, folder: &Path) {
        let file = ["a.sabi", "deep/a.sabi", "deep/er/b.sabi"][self.dice.below(3)];
        self.safe.push(self.document.session.text().to_owned());
        let kept = match self.dice.below(4) {
            0 => self.document.save_as(&folder.join(file)),
            // Without a file, saving must return an error.
            1 if self.document.session.file().is_none() => return assert!(self.document.session.save().is_err()),
            1 => self.document.session.save(),
            _ => self.document.session.keep(&[]).map(drop),
        };
        match kept {
            Ok(()) => self.safe = vec![self.document.session.text().to_owned()],
            // The file is newer than the recovered copy, since the program was killed after saving. The editor would ask
            // whether to replace the file; the answer here is yes.
            Err(error) if error.remedies.contains(&Remedy::ReplaceFile) => {
                self.document.session.graph_file.keep_document()
            }
            Err(error) => assert!(self.document.session.disk().has_ended(), "{error}"),
        }
    }
}

/// Opens the files that the killed program left: the copy of unsaved work, or the graph's file if that was saved last.
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

/// Edits a graph in a folder while the program is killed repeatedly. Returns the number of kills.
fn edited_with_kills(graph: usize, folder: &Path) -> usize {
    let kept = folder.join("kept");
    let mut session = Session::new(Some(&kept));
    let mut hands = RandomActions {
        safe: vec![session.text().to_owned()],
        document: document_with(Session::new(None), 0),
        dice: SplitMix64(graph as u64),
        clipboard: String::new(),
        kinds: kinds().catalog.entries().map(|entry| entry.id.clone()).collect(),
    };
    let (mut edits, mut kills) = (0, 0);
    while edits < EDITS / GRAPHS {
        let disk = Disk::failing(DiskFault::End, hands.dice.below(MOST_STEPS));
        hands.document = document_with(session.on_disk(&disk), kills as u64);
        while edits < EDITS / GRAPHS && !disk.has_ended() {
            hands.act(folder);
            hands.document.take_notices();
            edits += 1;
        }
        kills += usize::from(disk.has_ended());
        let file = hands.document.session.file().map(Path::to_owned);
        // A killed program runs no destructor, so nothing may be written here.
        hands.document = document_with(Session::new(None), 0);
        session = reopened(&kept, file.as_ref(), &hands.safe);
        hands.safe = vec![session.text().to_owned()];
    }
    kills
}

#[test]
fn random_edits_with_kills_lose_nothing_that_was_reported_as_saved() {
    let kills = (0..GRAPHS).map(|graph| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir_all(folder.path().join("deep/er")).expect("a writable folder");
        edited_with_kills(graph, folder.path())
    });
    let kills: usize = kills.sum();
    assert!(kills >= FEWEST_KILLS, "{kills}");
}
