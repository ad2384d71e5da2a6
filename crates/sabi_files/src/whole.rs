//! Whole files: written under a temporary name beside the target, then renamed.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::{fs, io::ErrorKind};

use tempfile::NamedTempFile;

use crate::error::{FileError, Operation};
use crate::paths::behind_links;
use crate::temporary::{PREFIX, temporary_in};

/// Durability of a commit: it waits until the disk has the data, or not.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Durability {
    /// Survives a power failure.
    Synced,
    /// Survives the end of the program only.
    Unsynced,
}

/// Replaces a file durably: after a crash or power failure it holds its earlier bytes or all of the new ones. Creates
/// missing folders; writes the file behind a symbolic link; keeps the permissions of the earlier file.
///
/// # Errors
/// The file is unchanged, unless the operation is [`Operation::SyncFolder`].
pub fn write_whole(file: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write(file, bytes, Durability::Synced)
}

/// Replaces a file like [`write_whole`] without waiting for the disk: complete after a crash of the program, but a power
/// failure shortly after may leave it empty.
///
/// # Errors
/// The file is unchanged.
pub fn write_unsynced(file: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write(file, bytes, Durability::Unsynced)
}

fn write(file: &Path, bytes: &[u8], durability: Durability) -> Result<(), FileError> {
    let file = &behind_links(file);
    create_folder(folder_of(file))?;
    let mut whole = WholeFile::create(file)?;
    whole.write(bytes)?;
    whole.place(durability)
}

/// File that is being written under a temporary name beside its target. Dropping it removes the temporary file.
#[derive(Debug)]
pub struct WholeFile {
    target: PathBuf,
    temporary: NamedTempFile,
}

impl WholeFile {
    /// Opens a temporary file beside the target; the target's folder must exist. A link at the target is replaced, not
    /// followed.
    ///
    /// # Errors
    /// The target has no file name, or its folder cannot be written to.
    pub fn create(target: &Path) -> Result<WholeFile, FileError> {
        WholeFile::create_named(target, OsStr::new(PREFIX))
    }

    /// Opens a temporary file whose name starts with `prefix`.
    pub(crate) fn create_named(target: &Path, prefix: &OsStr) -> Result<WholeFile, FileError> {
        let refused = |error| FileError::new(Operation::Write, target, error);
        if target.file_name().is_none() {
            return Err(refused(ErrorKind::InvalidFilename.into()));
        }
        let temporary = temporary_in(folder_of(target), prefix).map_err(refused)?;
        if let Ok(earlier) = fs::metadata(target) {
            // Some file systems have no permissions to keep.
            let _ = temporary.as_file().set_permissions(earlier.permissions());
        }
        Ok(WholeFile {
            target: target.to_owned(),
            temporary,
        })
    }

    /// Path of the finished file.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Appends bytes to the temporary file.
    ///
    /// # Errors
    /// The disk is full or gone.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        let written = write_through(self.temporary.as_file_mut(), bytes);
        written.map_err(|error| FileError::new(Operation::Write, &self.target, error))
    }

    /// The temporary file, for those who write it in parts.
    pub(crate) fn as_file_mut(&mut self) -> &mut fs::File {
        self.temporary.as_file_mut()
    }

    /// Waits until the disk has the bytes; some file systems report only here that there is no room.
    pub(crate) fn sync(&mut self) -> Result<(), FileError> {
        let synced = self.temporary.as_file().sync_all();
        synced.map_err(|error| FileError::new(Operation::Write, &self.target, error))
    }

    /// Puts the file in place durably.
    ///
    /// # Errors
    /// The target is unchanged, unless the operation is [`Operation::SyncFolder`].
    pub fn commit(self) -> Result<(), FileError> {
        self.place(Durability::Synced)
    }

    pub(crate) fn place(mut self, durability: Durability) -> Result<(), FileError> {
        if durability == Durability::Synced {
            self.sync()?;
        }
        let target = self.target;
        self.temporary
            .persist(&target)
            .map_err(|refused| FileError::new(Operation::Replace, &target, replace_error(&target, refused.error)))?;
        match durability {
            Durability::Synced => sync_folder(folder_of(&target)),
            Durability::Unsynced => Ok(()),
        }
    }

    /// Takes the value apart into target and temporary file.
    pub(crate) fn into_parts(self) -> (PathBuf, NamedTempFile) {
        (self.target, self.temporary)
    }
}

/// Systems answer differently when a folder has the target's name.
pub(crate) fn replace_error(target: &Path, error: io::Error) -> io::Error {
    if fs::symlink_metadata(target).is_ok_and(|found| found.is_dir()) {
        return ErrorKind::IsADirectory.into();
    }
    error
}

/// Returns the folder of a file, `.` for a plain name.
pub(crate) fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Creates a folder and those above it.
pub(crate) fn create_folder(folder: &Path) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(|error| FileError::new(Operation::CreateFolder, folder, error))
}

fn write_through(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.flush()
}

/// Writes a folder's entries to the disk, so that a renamed file keeps its new name after a power failure.
#[cfg(unix)]
pub(crate) fn sync_folder(folder: &Path) -> Result<(), FileError> {
    let synced = fs::File::open(folder).and_then(|folder| folder.sync_all());
    match synced {
        // Some network file systems cannot sync a folder, and a folder may be writable without being readable: there the
        // system decides when the entries reach the disk.
        Err(error)
            if !matches!(
                error.kind(),
                ErrorKind::InvalidInput | ErrorKind::Unsupported | ErrorKind::PermissionDenied
            ) =>
        {
            Err(FileError::new(Operation::SyncFolder, folder, error))
        }
        _ => Ok(()),
    }
}

/// Folders cannot be synced on this system; renaming is journaled by its file systems.
#[cfg(not(unix))]
pub(crate) fn sync_folder(_: &Path) -> Result<(), FileError> {
    Ok(())
}

#[cfg(test)]
mod tests;
