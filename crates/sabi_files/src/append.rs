//! Appending to a file that consists of records.

use std::fs::OpenOptions;
use std::path::Path;

use crate::disk::{Disk, DiskStep};
use crate::error::{FileError, Operation};

/// Appends bytes to a file and waits until they are on the disk. If that fails, the file is truncated to its earlier length
/// if possible. Readers of such files must accept that the last record may be incomplete.
///
/// # Errors
/// The file does not exist, or the disk refuses.
pub fn append_durably(file: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Disk::default().append_durably(file, bytes)
}

impl Disk {
    /// Appends bytes to a file durably, see [`append_durably`].
    ///
    /// # Errors
    /// The file does not exist, or the disk refuses.
    pub fn append_durably(&self, file: &Path, bytes: &[u8]) -> Result<(), FileError> {
        let failed = |error| FileError::new(Operation::Append, file, error);
        let mut open = OpenOptions::new().append(true).open(file).map_err(failed)?;
        let length = open.metadata().map_err(failed)?.len();
        let written = self.write(DiskStep::Append, file, &mut open, bytes);
        let written = written.and_then(|()| self.step(DiskStep::Sync, file, || open.sync_data()));
        written.map_err(|error| {
            // Report the first error, not an error of this cleanup.
            let _ = self.step(DiskStep::Shorten, file, || open.set_len(length));
            failed(error)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::append_durably;

    #[test]
    fn bytes_are_appended_to_the_existing_ones() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("strokes");
        assert!(
            append_durably(&file, b"nothing").is_err(),
            "a file that is not there is not begun"
        );
        crate::write_whole(&file, b"one").unwrap();
        append_durably(&file, b" two").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"one two");
    }
}
