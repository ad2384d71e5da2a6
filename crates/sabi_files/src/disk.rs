//! Access to the disk as a value: the real one, or one of a test that fails at a chosen step and knows what a power failure
//! would take.

mod record;

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use record::Record;

/// Disk that files are written to. By default the real one; clones of a disk of a test share its count.
#[derive(Clone, Debug, Default)]
pub struct Disk {
    /// Absent for the real disk.
    record: Option<Arc<Mutex<Record>>>,
}

/// Fault of the disk of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The system refuses one step; all others succeed.
    Refuse,
    /// There is no room from one step on: bytes and new names are refused, while removing and renaming succeed.
    Full,
    /// The process ends at one step: a write stops in its middle, and nothing happens after it, destructors included.
    End,
}

impl Fault {
    /// All faults.
    pub const ALL: [Fault; 3] = [Fault::Refuse, Fault::Full, Fault::End];
}

/// Change on the disk that can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    CreateFolder,
    /// A file or folder with a temporary name, in the folder that the step names.
    CreateTemporary,
    /// A file with its final name.
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

impl Step {
    /// Returns true if the step needs room.
    fn takes_room(self) -> bool {
        match self {
            Step::CreateFolder | Step::CreateTemporary | Step::CreateFile | Step::Write | Step::Link | Step::Append => {
                true
            }
            Step::Sync | Step::Rename | Step::SyncFolder | Step::Shorten | Step::Remove => false,
        }
    }
}

impl Disk {
    /// Disk of a test that counts its steps, without a fault.
    pub fn counting() -> Disk {
        Disk::with_record(Record::default())
    }

    /// Disk of a test with a fault at a step; steps are counted from 0.
    pub fn failing(fault: Fault, at: usize) -> Disk {
        Disk::with_record(Record::failing(fault, at))
    }

    /// Disks of a test, one for each fault at each of this many steps, with words for it.
    pub fn each_fault(steps: usize) -> impl Iterator<Item = (Disk, String)> {
        let faults = Fault::ALL.into_iter();
        let all = faults.flat_map(move |fault| (0..steps).map(move |at| (fault, at)));
        all.map(move |(fault, at)| (Disk::failing(fault, at), format!("{fault:?} at step {at} of {steps}")))
    }

    fn with_record(record: Record) -> Disk {
        Disk {
            record: Some(Arc::new(Mutex::new(record))),
        }
    }

    /// Number of steps so far; 0 on the real disk, which does not count.
    pub fn steps(&self) -> usize {
        self.record().map_or(0, |record| record.steps)
    }

    /// Returns whether temporary files stay when they are dropped, because the process is going to end.
    pub(crate) fn keeps_temporaries(&self) -> bool {
        self.record().is_some_and(|record| record.will_end())
    }

    /// Returns whether the process counts as ended: nothing changes on the disk any more.
    pub fn has_ended(&self) -> bool {
        self.record().is_some_and(|record| record.has_ended)
    }

    /// Files and folders that a power failure at this moment could take or leave incomplete; none on the real disk, which does
    /// not count.
    pub fn at_risk(&self) -> Vec<PathBuf> {
        self.record().map_or_else(Vec::new, |record| record.at_risk())
    }

    fn record(&self) -> Option<MutexGuard<'_, Record>> {
        let record = self.record.as_ref()?;
        // Every change of the record leaves it consistent.
        Some(record.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes a step, which changes a path: `work` makes the change.
    pub(crate) fn step<T>(&self, step: Step, path: &Path, work: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        if let Some(mut record) = self.record() {
            record.begin(step)?;
        }
        let done = work()?;
        if let Some(mut record) = self.record() {
            record.changed(step, path);
        }
        Ok(done)
    }

    /// Writes bytes at the end of an open file.
    pub(crate) fn write(&self, step: Step, path: &Path, file: &mut File, bytes: &[u8]) -> io::Result<()> {
        if let Some(mut record) = self.record()
            && let Err(error) = record.begin(step)
        {
            // A disk that fills up, and a process that ends, leave a part.
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

    /// Renames a file or a folder by `work`.
    pub(crate) fn rename<T>(&self, from: &Path, to: &Path, work: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        if let Some(mut record) = self.record() {
            record.begin(Step::Rename)?;
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
        self.step(Step::Remove, file, || fs::remove_file(file))
    }
}
