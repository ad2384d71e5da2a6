//! Writing of a recovery file on a separate thread.

use std::io;
use std::path::{Path, PathBuf};
use std::thread::{Builder, JoinHandle};

use sabi_files::{Disk, FileError, Operation};

use super::UnsavedWork;

/// A recovery file that is being written. Dropping it waits for the disk.
#[derive(Debug)]
pub(super) struct Writing {
    path: PathBuf,
    work: UnsavedWork,
    /// Thread; `None` after waiting for it, or if no thread could be started.
    thread: Option<JoinHandle<Result<(), FileError>>>,
}

impl Writing {
    /// Starts to write these bytes, which hold the work.
    ///
    /// # Errors
    /// The system gives no thread, and the disk refuses.
    pub(super) fn start(disk: &Disk, path: &Path, bytes: Vec<u8>, work: UnsavedWork) -> Result<Writing, FileError> {
        let (own_disk, own_path, own_bytes) = (disk.clone(), path.to_owned(), bytes.clone());
        let write = move || own_disk.write_whole(&own_path, &own_bytes);
        let thread = Builder::new().name("sabi autosave".to_owned()).spawn(write).ok();
        if thread.is_none() {
            disk.write_whole(path, &bytes)?;
        }
        Ok(Writing {
            path: path.to_owned(),
            work,
            thread,
        })
    }

    /// Returns true if the file has been written, or could not be written.
    pub(super) fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Waits for the disk, and returns the work that is now in the file.
    pub(super) fn finish(mut self) -> Result<UnsavedWork, FileError> {
        let written = self.thread.take().map_or(Ok(Ok(())), JoinHandle::join);
        let panicked = |_| {
            Err(FileError {
                operation: Operation::Write,
                path: self.path.clone(),
                source: io::Error::other("its thread has ended"),
            })
        };
        written.unwrap_or_else(panicked)?;
        Ok(std::mem::take(&mut self.work))
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            // If writing failed, the work is missing from the recovery file, as if the program had ended a moment earlier.
            let _ = thread.join();
        }
    }
}
