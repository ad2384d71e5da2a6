//! Whole files: written under a temporary name beside the target, then renamed.

pub(crate) mod part_writer;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::{fs, io::ErrorKind};

use tempfile::NamedTempFile;

use crate::disk::{Disk, DiskStep};
use crate::error::{FileError, Operation};
use crate::paths::behind_links;
use crate::temporary::{PREFIX, temporary_in};

/// Durability of a commit: whether it waits until the data is on the disk.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Durability {
    /// Survives a power failure.
    Synced,
    /// Survives only the end of the program.
    Unsynced,
}

/// Replaces a file durably: after a crash or power failure it has either its earlier bytes or all new bytes. Creates
/// missing folders, writes to the target of a symbolic link, and keeps the permissions of the earlier file.
///
/// # Errors
/// The file is unchanged, unless the operation is [`Operation::SyncFolder`].
pub fn write_whole(file: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Disk::default().write_whole(file, bytes)
}

impl Disk {
    /// Replaces a file durably, see [`write_whole`].
    ///
    /// # Errors
    /// The file is unchanged, unless the operation is [`Operation::SyncFolder`].
    pub fn write_whole(&self, file: &Path, bytes: &[u8]) -> Result<(), FileError> {
        let file = &behind_links(file);
        let mut whole = self.begin_whole(file)?;
        whole.write(bytes)?;
        whole.place(Durability::Synced)
    }

    /// Writes a new file durably. An existing file is never changed. Creates missing folders.
    ///
    /// # Errors
    /// The file exists ([`ErrorKind::AlreadyExists`]), or the disk refuses; there is no new file, unless the operation is
    /// [`Operation::SyncFolder`].
    pub fn write_new(&self, file: &Path, bytes: &[u8]) -> Result<(), FileError> {
        let mut whole = self.begin_whole(file)?;
        whole.write(bytes)?;
        whole.place_new()
    }

    fn begin_whole(&self, file: &Path) -> Result<WholeFile, FileError> {
        create_folder(self, folder_of(file), Durability::Synced)?;
        WholeFile::create_named(self, file, OsStr::new(PREFIX))
    }
}

/// File that is being written under a temporary name beside its target. Dropping it removes the temporary file.
#[derive(Debug)]
pub struct WholeFile {
    disk: Disk,
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
        WholeFile::create_on(&Disk::default(), target)
    }

    /// Opens a temporary file on a disk, as [`WholeFile::create`] does.
    ///
    /// # Errors
    /// The target has no file name, or its folder cannot be written to.
    pub fn create_on(disk: &Disk, target: &Path) -> Result<WholeFile, FileError> {
        WholeFile::create_named(disk, target, OsStr::new(PREFIX))
    }

    /// Opens a temporary file whose name starts with `prefix`.
    pub(crate) fn create_named(disk: &Disk, target: &Path, prefix: &OsStr) -> Result<WholeFile, FileError> {
        let refused = |error| FileError::new(Operation::Write, target, error);
        if target.file_name().is_none() {
            return Err(refused(ErrorKind::InvalidFilename.into()));
        }
        let temporary = temporary_in(disk, folder_of(target), prefix).map_err(refused)?;
        if let Ok(earlier) = fs::metadata(target) {
            // Some file systems have no permissions.
            let _ = temporary.as_file().set_permissions(earlier.permissions());
        }
        Ok(WholeFile {
            disk: disk.clone(),
            target: target.to_owned(),
            temporary,
        })
    }

    /// Returns the path of the finished file.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Appends bytes to the temporary file.
    ///
    /// # Errors
    /// The disk is full or not available.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        let path = self.temporary.path().to_owned();
        let written = self
            .disk
            .write(DiskStep::Write, &path, self.temporary.as_file_mut(), bytes);
        written.map_err(|error| FileError::new(Operation::Write, &self.target, error))
    }

    /// Returns the temporary file, for setting its permissions and times.
    pub(crate) fn as_file_mut(&mut self) -> &mut fs::File {
        self.temporary.as_file_mut()
    }

    /// Waits until the bytes are on the disk. Some file systems report only here that the disk is full.
    pub(crate) fn sync(&mut self) -> Result<(), FileError> {
        let file = self.temporary.as_file();
        let synced = self
            .disk
            .step(DiskStep::Sync, self.temporary.path(), || file.sync_all());
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
        let WholeFile {
            disk,
            target,
            temporary,
        } = self;
        let from = temporary.path().to_owned();
        let placed = disk.rename(&from, &target, || {
            temporary.persist(&target).map(drop).map_err(|refused| refused.error)
        });
        placed.map_err(|error| FileError::new(Operation::Replace, &target, replace_error(&target, error)))?;
        match durability {
            Durability::Synced => sync_folder(&disk, folder_of(&target)),
            Durability::Unsynced => Ok(()),
        }
    }

    /// Puts the file in place durably, unless a file exists there.
    fn place_new(mut self) -> Result<(), FileError> {
        self.sync()?;
        let WholeFile {
            disk,
            target,
            temporary,
        } = self;
        let from = temporary.path().to_owned();
        let placed = disk.rename(&from, &target, || {
            let placed = temporary.persist_noclobber(&target);
            placed.map(drop).map_err(|refused| refused.error)
        });
        placed.map_err(|error| FileError::new(Operation::Replace, &target, error))?;
        sync_folder(&disk, folder_of(&target))
    }

    /// Returns target and temporary file.
    pub(crate) fn into_parts(self) -> (PathBuf, NamedTempFile) {
        (self.target, self.temporary)
    }
}

/// Returns the same error on all systems if a folder has the target's name.
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

/// Creates a folder and its missing parents. If this has to be durable, each parent is synced.
pub(crate) fn create_folder(disk: &Disk, folder: &Path, durability: Durability) -> Result<(), FileError> {
    for missing in missing_folders(folder) {
        // Another process may create the folder at the same moment.
        let created = disk.step(DiskStep::CreateFolder, missing, || fs::create_dir_all(missing));
        created.map_err(|error| FileError::new(Operation::CreateFolder, folder, error))?;
        if durability == Durability::Synced {
            sync_folder(disk, folder_of(missing))?;
        }
    }
    // If a file is in the way, no folder is missing, and this returns the error.
    fs::create_dir_all(folder).map_err(|error| FileError::new(Operation::CreateFolder, folder, error))
}

/// Lists a folder and those above it that do not exist, outermost first.
pub(crate) fn missing_folders(folder: &Path) -> Vec<&Path> {
    let is_missing = |part: &&Path| !part.as_os_str().is_empty() && !part.exists();
    let mut missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    missing.reverse();
    missing
}

/// Syncs the entries of a folder, so that a renamed file keeps its new name after a power failure.
#[cfg(unix)]
pub(crate) fn sync_folder(disk: &Disk, folder: &Path) -> Result<(), FileError> {
    let synced = disk.step(DiskStep::SyncFolder, folder, || {
        fs::File::open(folder).and_then(|folder| folder.sync_all())
    });
    match synced {
        // Some network file systems cannot sync a folder, and a folder may be writable but not readable. In these cases the
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

/// Does nothing: folders cannot be synced on this system, whose file systems record renames in a journal.
#[cfg(not(unix))]
pub(crate) fn sync_folder(disk: &Disk, folder: &Path) -> Result<(), FileError> {
    let synced = disk.step(DiskStep::SyncFolder, folder, || Ok(()));
    synced.map_err(|error| FileError::new(Operation::SyncFolder, folder, error))
}

#[cfg(test)]
mod tests;
