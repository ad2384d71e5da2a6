//! Record of the steps of a test disk.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use super::{DiskFault, DiskStep};

/// Steps so far, and changes that have not reached the disk yet.
#[derive(Debug, Default)]
pub(super) struct Record {
    /// Fault, and the step at which it occurs.
    fault: Option<(DiskFault, usize)>,
    pub(super) steps: usize,
    pub(super) has_ended: bool,
    is_full: bool,
    /// Files with bytes that have not been synced.
    unsynced: BTreeSet<PathBuf>,
    /// Names that were created in folders that have not been synced since.
    unsynced_names: BTreeSet<PathBuf>,
}

impl Record {
    pub(super) fn failing(fault: DiskFault, at: usize) -> Record {
        Record {
            fault: Some((fault, at)),
            ..Record::default()
        }
    }

    /// Returns whether the simulated process is going to end.
    pub(super) fn will_end(&self) -> bool {
        self.fault.is_some_and(|(fault, _)| fault == DiskFault::End)
    }

    /// Counts a step. Returns the error of the system if the step fails.
    pub(super) fn begin(&mut self, step: DiskStep) -> io::Result<()> {
        let at = self.steps;
        self.steps += 1;
        let is_reached = |wanted: DiskFault| self.fault.is_some_and(|(fault, from)| fault == wanted && at >= from);
        if is_reached(DiskFault::End) {
            self.has_ended = true;
            return Err(io::Error::other("the process has ended"));
        }
        if is_reached(DiskFault::Full) && step.takes_room() {
            self.is_full = true;
            return Err(io::ErrorKind::StorageFull.into());
        }
        if self.fault == Some((DiskFault::Refuse, at)) {
            return Err(io::Error::other("the disk does not answer"));
        }
        Ok(())
    }

    /// Returns whether the failed write has written a part of its bytes.
    pub(super) fn leaves_parts(&self) -> bool {
        let at = self.steps.checked_sub(1);
        // After the process has ended, later writes write nothing.
        let is_first = self.fault.is_some_and(|(_, from)| Some(from) == at);
        self.has_ended && is_first || self.is_full
    }

    /// Records a change.
    pub(super) fn changed(&mut self, step: DiskStep, path: &Path) {
        let path = path.to_owned();
        match step {
            DiskStep::CreateFolder | DiskStep::CreateFile => {
                self.unsynced_names.insert(path);
            }
            // Links have temporary names as well, whose loss does not matter. For renaming see `renamed`.
            DiskStep::CreateTemporary | DiskStep::Link | DiskStep::Rename => {}
            DiskStep::Write | DiskStep::Append | DiskStep::Shorten => {
                self.unsynced.insert(path);
            }
            DiskStep::Sync => {
                self.unsynced.remove(&path);
            }
            DiskStep::SyncFolder => self.unsynced_names.retain(|name| name.parent() != Some(&path)),
            DiskStep::Remove => {
                self.unsynced.remove(&path);
                self.unsynced_names.remove(&path);
            }
        }
    }

    /// Records that a file or folder was renamed, including everything in it.
    pub(super) fn renamed(&mut self, from: &Path, to: &Path) {
        self.unsynced.remove(to);
        for paths in [&mut self.unsynced, &mut self.unsynced_names] {
            let moved = |path: PathBuf| match path.strip_prefix(from) {
                // Joining an empty path would add a separator at the end.
                Ok(below) if below.as_os_str().is_empty() => to.to_owned(),
                Ok(below) => to.join(below),
                Err(_) => path,
            };
            *paths = std::mem::take(paths).into_iter().map(moved).collect();
        }
        self.unsynced_names.insert(to.to_owned());
    }

    /// Returns the files and folders that a power failure could remove or leave incomplete.
    pub(super) fn at_risk(&self) -> Vec<PathBuf> {
        let all = self.unsynced.union(&self.unsynced_names);
        // Temporary files are removed without a step.
        all.filter(|path| path.exists()).cloned().collect()
    }
}
