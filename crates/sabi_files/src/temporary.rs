//! Temporary files and folders: their names, and those that a process left because it was killed.
//!
//! The process that writes a temporary file, or fills a folder, holds a lock on it, which the system ends with the process however it ends.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::disk::{Disk, Step};

/// Start of temporary names: hidden, and short enough that no target's name makes them too long.
pub(crate) const PREFIX: &str = ".sabi-";
/// End of temporary names.
const SUFFIX: &str = ".tmp";
/// Tries to open a temporary file that nobody removes before it is claimed.
const MOST_CLAIMS: usize = 8;

/// Returns whether a file name is that of a temporary file.
pub fn is_temporary_name(name: &str) -> bool {
    name.starts_with(PREFIX) && name.ends_with(SUFFIX)
}

/// Names of temporary files: unused, hidden, removed on drop.
pub(crate) fn temporary_names<'a>(prefix: &'a OsStr) -> tempfile::Builder<'a, 'static> {
    let mut names = tempfile::Builder::new();
    names.prefix(prefix).suffix(SUFFIX);
    names
}

/// Opens a new file (`create_new`) under an unused temporary name.
pub(crate) fn temporary_in(disk: &Disk, folder: &Path, prefix: &OsStr) -> io::Result<NamedTempFile> {
    let mut names = temporary_names(prefix);
    #[cfg(unix)]
    {
        // As for any new file; the system takes away what the user's mask says.
        let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o666);
        names.permissions(permissions);
    }
    names.disable_cleanup(disk.keeps_temporaries());
    let mut temporary = disk.step(Step::CreateTemporary, folder, || names.tempfile_in(folder))?;
    for _ in 0..MOST_CLAIMS {
        if claim(temporary.as_file(), temporary.path()) {
            break;
        }
        temporary = names.tempfile_in(folder)?;
    }
    Ok(temporary)
}

/// A folder with a temporary name, removed on drop.
#[derive(Debug)]
pub(crate) struct TemporaryFolder {
    folder: TempDir,
    /// Handle with the lock; none where the system opens no folders.
    _lock: Option<File>,
}

impl TemporaryFolder {
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Leaves the folder where it is.
    pub(crate) fn keep(self) {
        let _ = self.folder.keep();
    }
}

/// Makes a folder under an unused temporary name.
pub(crate) fn temporary_folder_in(disk: &Disk, folder: &Path) -> io::Result<TemporaryFolder> {
    let mut names = temporary_names(OsStr::new(PREFIX));
    #[cfg(unix)]
    {
        // As for any new folder; the system takes away what the user's mask says.
        let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o777);
        names.permissions(permissions);
    }
    names.disable_cleanup(disk.keeps_temporaries());
    let mut made = disk.step(Step::CreateTemporary, folder, || names.tempdir_in(folder))?;
    for _ in 0..MOST_CLAIMS {
        let lock = match File::open(made.path()) {
            Ok(handle) => Some(handle),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            // The system opens no folders.
            Err(_) => {
                return Ok(TemporaryFolder {
                    folder: made,
                    _lock: None,
                });
            }
        };
        if let Some(handle) = lock
            && claim(&handle, made.path())
        {
            return Ok(TemporaryFolder {
                folder: made,
                _lock: Some(handle),
            });
        }
        // Another process took it for a left-over before it was locked.
        made = names.tempdir_in(folder)?;
    }
    Err(io::Error::other(
        "other programs remove its temporary folder again and again",
    ))
}

/// Claims a temporary file while its handle is open. Returns false where another process takes it for a left-over, between its
/// making and the claim.
pub(crate) fn claim(file: &File, path: &Path) -> bool {
    // On a file system without locks nobody removes it either: what cannot be locked is not swept.
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock)) && path.exists()
}

/// Removes the temporary files in a folder that nobody writes. What cannot be removed stays, as it harms nobody.
pub fn sweep(folder: &Path) {
    for path in left_overs(folder, fs::FileType::is_file) {
        let is_free = File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if is_free {
            let _ = fs::remove_file(&path);
        }
    }
}

/// Removes the temporary folders of a folder that no process fills, with all that is in them. Where the system opens no folders,
/// they stay.
pub(crate) fn sweep_folders(folder: &Path) {
    for path in left_overs(folder, fs::FileType::is_dir) {
        let handle = File::open(&path);
        if handle.is_ok_and(|handle| handle.try_lock().is_ok()) {
            let _ = fs::remove_dir_all(&path);
        }
    }
}

/// Lists what has a temporary name in a folder and is of a kind, sorted.
fn left_overs(folder: &Path, is_meant: fn(&fs::FileType) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_temporary = |entry: &fs::DirEntry| {
        is_temporary_name(&entry.file_name().to_string_lossy()) && entry.file_type().is_ok_and(|kind| is_meant(&kind))
    };
    let mut found: Vec<_> = entries.filter(is_temporary).map(|entry| entry.path()).collect();
    found.sort();
    found
}
