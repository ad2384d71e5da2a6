//! Files that are written in parts, not only from start to end.

use std::cell::OnceCell;
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};

use super::WholeFile;
use crate::error::{FileError, Operation};

/// Writer of a [`WholeFile`] that ignores writes after a failure and reports success. This is needed because the zip writer
/// finishes the archive in its destructor and panics if writing fails there.
pub(crate) struct PartWriter<'a> {
    whole: &'a mut WholeFile,
    failure: &'a OnceCell<FileError>,
    position: u64,
    end: u64,
}

impl<'a> PartWriter<'a> {
    /// Starts at the beginning of a file. The first failure is stored in `failure`, which must be empty.
    pub(crate) fn new(whole: &'a mut WholeFile, failure: &'a OnceCell<FileError>) -> PartWriter<'a> {
        PartWriter {
            whole,
            failure,
            position: 0,
            end: 0,
        }
    }

    /// Performs work on the file, unless earlier work has failed.
    fn attempt(&mut self, work: impl FnOnce(&mut WholeFile) -> Result<(), FileError>) {
        if self.failure.get().is_none()
            && let Err(error) = work(self.whole)
        {
            // The cell is empty, as was just checked.
            let _ = self.failure.set(error);
        }
    }
}

impl Write for PartWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.attempt(|whole| whole.write(bytes));
        self.position += bytes.len() as u64;
        self.end = self.end.max(self.position);
        Ok(bytes.len())
    }

    /// Does nothing, since nothing is buffered.
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for PartWriter<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(step) => self.position.checked_add_signed(step),
            SeekFrom::End(step) => self.end.checked_add_signed(step),
        };
        self.position = place.ok_or(ErrorKind::InvalidInput)?;
        let start = SeekFrom::Start(self.position);
        self.attempt(|whole| {
            let found = whole.temporary.as_file_mut().seek(start);
            found
                .map(drop)
                .map_err(|error| FileError::new(Operation::Write, &whole.target, error))
        });
        Ok(self.position)
    }
}
