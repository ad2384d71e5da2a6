//! Graphs and node files that were not saved when a program ended, and those of programs that are still ending.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::Context;
use sabi_engine::session::{Recovery, recoveries, recoveries_in_use};

use crate::paths::canonical_if_present;

/// Time for which recovery files in use are looked at again: a program that was killed holds them until the system has ended it. On
/// a loaded machine, that takes many seconds.
const AWAITED_FOR: Duration = Duration::from_secs(60);
/// Time between two checks.
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// Graphs and node files that were not saved when a program ended.
pub(crate) struct Recoveries {
    folder: Option<PathBuf>,
    pub(crate) found: Vec<Recovery>,
    /// Recovery files that are in use by a program that may be about to end.
    awaited: Vec<PathBuf>,
    /// Time until which `awaited` is checked, and that of the next check.
    awaited_until: Instant,
    next_look: Instant,
    /// True until unsaved work on the open graph's file was offered.
    pub(super) is_offer_due: bool,
}

impl Recoveries {
    /// Finds the unsaved work in a folder.
    pub(super) fn in_folder(folder: Option<&Path>) -> Recoveries {
        let now = Instant::now();
        let mut new = Recoveries {
            folder: folder.map(Path::to_owned),
            found: Vec::new(),
            awaited: Vec::new(),
            awaited_until: now,
            next_look: now,
            is_offer_due: false,
        };
        new.look();
        new
    }

    /// Searches the folder for unsaved work. Called when a graph is opened.
    pub(super) fn look(&mut self) {
        let Some(folder) = &self.folder else { return };
        // First, so that a file that is released in between is not missed.
        self.awaited = recoveries_in_use(folder);
        for recovery in recoveries(folder) {
            if self.found.iter().all(|known| known.path() != recovery.path()) {
                self.awaited.retain(|awaited| awaited != recovery.path());
                self.found.push(recovery);
            }
        }
        self.awaited_until = Instant::now() + AWAITED_FOR;
        self.is_offer_due = true;
    }

    /// Adds the files that ending programs have released meanwhile. Returns whether there are any.
    pub(super) fn take_freed(&mut self, context: &Context) -> bool {
        let now = Instant::now();
        if self.awaited.is_empty() || now < self.next_look {
            return false;
        }
        if now > self.awaited_until {
            // These files belong to windows that are still in use.
            self.awaited.clear();
            return false;
        }
        self.next_look = now + LOOK_AGAIN;
        context.request_repaint_after(LOOK_AGAIN);
        let before = self.found.len();
        let found = &mut self.found;
        self.awaited.retain(|path| match Recovery::of_file(path) {
            Some(recovery) => {
                found.push(recovery);
                false
            }
            None => path.exists(),
        });
        self.is_offer_due |= self.found.len() > before;
        self.found.len() > before
    }

    /// Index of the newest unsaved work on a graph file.
    pub(super) fn of_file(&self, file: &Path) -> Option<usize> {
        let file = canonical_if_present(file);
        let is_of_it = |recovery: &Recovery| {
            let own = recovery.file().map(canonical_if_present);
            recovery.has_graph() && own.as_ref() == Some(&file)
        };
        let of_it = self.found.iter().enumerate().filter(|(_, recovery)| is_of_it(recovery));
        of_it.max_by_key(|(_, recovery)| recovery.when()).map(|(at, _)| at)
    }
}
