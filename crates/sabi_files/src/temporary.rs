//! Temporary files and folders: their names, and removal of those that killed processes have left.
//!
//! The process that writes a temporary file, or fills a temporary folder, holds a lock on it. The system releases the lock
//! when the process ends for any reason.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::disk::{Disk, DiskStep};

/// Start of temporary names: hidden, and short enough that the names do not become too long.
pub(crate) const PREFIX: &str = ".sabi-";
/// End of temporary names.
const SUFFIX: &str = ".tmp";
/// Number of attempts to create a temporary file that no other process removes before it is locked.
const MOST_CLAIMS: usize = 8;

/// Returns whether a file name is the name of a temporary file.
pub fn is_temporary_name(name: &str) -> bool {
    name.starts_with(PREFIX) && name.ends_with(SUFFIX)
}

/// Builds temporary files with unused, hidden names that are removed on drop.
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
        // The usual permissions of new files, from which the system removes those in the user's mask.
        let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o666);
        names.permissions(permissions);
    }
    names.disable_cleanup(disk.keeps_temporaries());
    let mut temporary = disk.step(DiskStep::CreateTemporary, folder, || names.tempfile_in(folder))?;
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
    /// Handle with the lock; `None` on systems that cannot open folders.
    _lock: Option<File>,
}

impl TemporaryFolder {
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Keeps the folder instead of removing it on drop.
    pub(crate) fn keep(self) {
        let _ = self.folder.keep();
    }
}

/// Creates a folder under an unused temporary name.
pub(crate) fn temporary_folder_in(disk: &Disk, folder: &Path) -> io::Result<TemporaryFolder> {
    let mut names = temporary_names(OsStr::new(PREFIX));
    #[cfg(unix)]
    {
        // The usual permissions of new folders, from which the system removes those in the user's mask.
        let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o777);
        names.permissions(permissions);
    }
    names.disable_cleanup(disk.keeps_temporaries());
    let mut made = disk.step(DiskStep::CreateTemporary, folder, || names.tempdir_in(folder))?;
    for _ in 0..MOST_CLAIMS {
        let lock = match File::open(made.path()) {
            Ok(handle) => Some(handle),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            // This system cannot open folders.
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
        // Another process removed the folder as a left-over before it was locked. Create another one.
        made = names.tempdir_in(folder)?;
    }
    Err(io::Error::other(
        "other programs remove its temporary folder again and again",
    ))
}

/// Locks a temporary file for as long as its handle is open. Returns false if another process has taken it for a left-over
/// between its creation and this call.
pub(crate) fn claim(file: &File, path: &Path) -> bool {
    // On a file system without locks no process removes the file either: files that cannot be locked are not swept.
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock)) && path.exists()
}

/// Removes the temporary files in a folder that no process is writing. Files that cannot be removed are left; they do no harm.
pub fn sweep(folder: &Path) {
    for path in left_overs(folder, fs::FileType::is_file) {
        let is_free = File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if is_free {
            let _ = fs::remove_file(&path);
        }
    }
}

/// Removes the temporary folders in a folder that no process is filling, with their contents. On systems that cannot open
/// folders, they are left.
pub(crate) fn sweep_folders(folder: &Path) {
    for path in left_overs(folder, fs::FileType::is_dir) {
        let handle = File::open(&path);
        if handle.is_ok_and(|handle| handle.try_lock().is_ok()) {
            let _ = fs::remove_dir_all(&path);
        }
    }
}

/// Lists the files or folders (selected by `is_meant`) in a folder that have temporary names, sorted.
fn left_overs(folder: &Path, is_meant: fn(&fs::FileType) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_temporary = |entry: &fs::DirEntry| {
        is_temporary_name(&entry.file_name().to_string_lossy()) && entry.file_type().is_ok_and(|kind| is_meant(&kind))
    };
    let mut found: Vec<_> = entries.filter(is_temporary).map(|entry| entry.path()).collect();
    found.sort();
    found
}
