//! Access to the disk as a value: the real disk, or a test disk that fails at a chosen step and records which changes a
//! power failure could undo.

mod record;

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use record::Record;

/// Disk to which files are written. The default is the real disk. Clones of a test disk share its step counter.
#[derive(Clone, Debug, Default)]
pub struct Disk {
    /// Record of a test disk; `None` for the real disk.
    record: Option<Arc<Mutex<Record>>>,
}

/// Fault of a test disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiskFault {
    /// The system refuses one step. All other steps succeed.
    Refuse,
    /// The disk is full from one step on: bytes and new names are refused, but removing and renaming succeed.
    Full,
    /// The process ends at one step: a write stops in the middle, and nothing happens after it, not even destructors.
    End,
}

impl DiskFault {
    /// All faults.
    pub const ALL: [DiskFault; 3] = [DiskFault::Refuse, DiskFault::Full, DiskFault::End];
}

/// Step that changes the disk and can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DiskStep {
    CreateFolder,
    /// Creating a file or folder with a temporary name, in the folder that the step names.
    CreateTemporary,
    /// Creating a file with its final name.
    CreateFile,
    Write,
    Sync,
    Link,
    Rename,
    SyncFolder,
    Append,
    Shorten,
    Remove,
}

impl DiskStep {
    /// Returns true if the step needs free space.
    fn takes_room(self) -> bool {
        match self {
            DiskStep::CreateFolder
            | DiskStep::CreateTemporary
            | DiskStep::CreateFile
            | DiskStep::Write
            | DiskStep::Link
            | DiskStep::Append => true,
            DiskStep::Sync | DiskStep::Rename | DiskStep::SyncFolder | DiskStep::Shorten | DiskStep::Remove => false,
        }
    }
}

impl Disk {
    /// Creates a test disk that counts its steps and has no fault.
    pub fn counting() -> Disk {
        Disk::with_record(Record::default())
    }

    /// Creates a test disk with a fault at a step. Steps are counted from 0.
    pub fn failing(fault: DiskFault, at: usize) -> Disk {
        Disk::with_record(Record::failing(fault, at))
    }

    /// Creates test disks, one for each fault at each of this many steps, each with a description.
    pub fn each_fault(steps: usize) -> impl Iterator<Item = (Disk, String)> {
        let faults = DiskFault::ALL.into_iter();
        let all = faults.flat_map(move |fault| (0..steps).map(move |at| (fault, at)));
        all.map(move |(fault, at)| (Disk::failing(fault, at), format!("{fault:?} at step {at} of {steps}")))
    }

    fn with_record(record: Record) -> Disk {
        Disk {
            record: Some(Arc::new(Mutex::new(record))),
        }
    }

    /// Returns the number of steps so far; 0 on the real disk, which does not count them.
    pub fn steps(&self) -> usize {
        self.record().map_or(0, |record| record.steps)
    }

    /// Returns whether temporary files are kept when they are dropped, because the simulated process is going to end.
    pub(crate) fn keeps_temporaries(&self) -> bool {
        self.record().is_some_and(|record| record.will_end())
    }

    /// Returns whether the simulated process has ended, so that nothing changes on the disk any more.
    pub fn has_ended(&self) -> bool {
        self.record().is_some_and(|record| record.has_ended)
    }

    /// Returns the files and folders that a power failure at this moment could remove or leave incomplete; none on the real
    /// disk, which does not record this.
    pub fn at_risk(&self) -> Vec<PathBuf> {
        self.record().map_or_else(Vec::new, |record| record.at_risk())
    }

    fn record(&self) -> Option<MutexGuard<'_, Record>> {
        let record = self.record.as_ref()?;
        // A panic cannot leave the record inconsistent, so poisoning is ignored.
        Some(record.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Performs a step that changes a path: `work` makes the change.
    pub(crate) fn step<T>(&self, step: DiskStep, path: &Path, work: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        if let Some(mut record) = self.record() {
            record.begin(step)?;
        }
        let done = work()?;
        if let Some(mut record) = self.record() {
            record.changed(step, path);
        }
        Ok(done)
    }

    /// Appends bytes to an open file.
    pub(crate) fn write(&self, step: DiskStep, path: &Path, file: &mut File, bytes: &[u8]) -> io::Result<()> {
        if let Some(mut record) = self.record()
            && let Err(error) = record.begin(step)
        {
            // A disk that becomes full, and a process that ends, write a part of the bytes.
            if record.leaves_parts() {
                file.write_all(&bytes[..bytes.len() / 2])?;
                record.changed(step, path);
            }
            return Err(error);
        }
        file.write_all(bytes).and_then(|()| file.flush())?;
        if let Some(mut record) = self.record() {
            record.changed(step, path);
        }
        Ok(())
    }

    /// Renames a file or a folder. `work` makes the change.
    pub(crate) fn rename<T>(&self, from: &Path, to: &Path, work: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        if let Some(mut record) = self.record() {
            record.begin(DiskStep::Rename)?;
        }
        let done = work()?;
        if let Some(mut record) = self.record() {
            record.renamed(from, to);
        }
        Ok(done)
    }

    /// Removes a file.
    ///
    /// # Errors
    /// It does not exist, or the system refuses.
    pub fn remove(&self, file: &Path) -> io::Result<()> {
        self.step(DiskStep::Remove, file, || fs::remove_file(file))
    }
}
