//! Locks that tell other processes that a file is in use.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use crate::disk::Disk;
use crate::error::{FileError, Operation};
use crate::whole::{Durability, create_folder, folder_of};

/// Number of times that a lock in use, or a folder that is gone, is tried again.
const TRIES: usize = 2;
/// Pause before a lock in use is tried again.
const BETWEEN_TRIES: Duration = Duration::from_millis(5);

/// Pause between two attempts while waiting for a lock.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// Lock on a file. It is held until it is dropped or the process ends for any reason.
#[derive(Debug)]
pub struct FileLock {
    /// Open file; closing it releases the lock.
    _file: File,
    path: PathBuf,
}

/// Failure to acquire a lock.
#[derive(Debug, Error)]
pub enum LockError {
    /// Another holder, in this process or another, has the lock.
    #[error("{} is in use by another program", path.display())]
    InUse {
        /// File of the lock.
        path: PathBuf,
    },
    /// The file cannot be created, or its file system has no locks.
    #[error(transparent)]
    Unavailable(#[from] FileError),
}

impl FileLock {
    /// Locks a file, waiting a few milliseconds at most. The file and its folder are created if they are missing.
    ///
    /// # Errors
    /// The lock is held already, or the file system does not offer it.
    pub fn acquire(path: &Path) -> Result<FileLock, LockError> {
        let mut tries = 0;
        loop {
            let file = open(path)?;
            match file.try_lock() {
                // Its holder may have removed the file after it was opened here and before it was locked.
                Ok(()) if !is_at(&file, path) => {}
                Ok(()) => {
                    let path = path.to_owned();
                    return Ok(FileLock { _file: file, path });
                }
                // The check in `is_locked` holds the lock only for a moment, while a real holder keeps it for longer.
                Err(TryLockError::WouldBlock) if tries < TRIES => {
                    tries += 1;
                    std::thread::sleep(BETWEEN_TRIES);
                }
                Err(TryLockError::WouldBlock) => return Err(LockError::InUse { path: path.to_owned() }),
                Err(TryLockError::Error(error)) => return Err(FileError::new(Operation::Lock, path, error).into()),
            }
        }
    }

    /// Waits until no other holder has the lock, and locks the file. The file and its folder are created if they are
    /// missing, also when a holder has removed them. While waiting, `goes_on` is called many times a second; when it
    /// returns false, the result is `None`.
    ///
    /// # Errors
    /// The file system does not offer locks, or the path is not an ordinary file.
    pub fn wait(path: &Path, goes_on: &mut dyn FnMut() -> bool) -> Result<Option<FileLock>, FileError> {
        loop {
            let file = open(path)?;
            loop {
                match file.try_lock() {
                    // Its holder removed the file that was opened here, and the next holder locks another one.
                    Ok(()) if !is_at(&file, path) => break,
                    Ok(()) => {
                        let path = path.to_owned();
                        return Ok(Some(FileLock { _file: file, path }));
                    }
                    Err(TryLockError::WouldBlock) if goes_on() => std::thread::sleep(BETWEEN_LOOKS),
                    Err(TryLockError::WouldBlock) => return Ok(None),
                    Err(TryLockError::Error(error)) => return Err(FileError::new(Operation::Lock, path, error)),
                }
            }
        }
    }

    /// Unlocks the file and removes it.
    pub fn remove(self) {
        // If the file cannot be removed, it is still unlocked, and other processes only check the lock.
        let _ = fs::remove_file(&self.path);
    }
}

/// Returns whether the file at a path is this open file, and not another file or none.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    let here = file.metadata().map(identity);
    // If the file cannot be examined, it is treated as the same one, since the caller would otherwise try forever.
    fs::metadata(path).map(identity).map_or_else(
        |error| error.kind() != std::io::ErrorKind::NotFound,
        |there| here.map_or(true, |here| here == there),
    )
}

/// Returns true: on this system an open file keeps its name.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// Opens the file of a lock. The file and its folder are created if they are missing.
fn open(path: &Path) -> Result<File, FileError> {
    let mut tries = 0;
    loop {
        // A lock does not outlive the process, so its folder need not be durable.
        create_folder(&Disk::default(), folder_of(path), Durability::Unsynced)?;
        refuse_special(path)?;
        match OpenOptions::new().write(true).create(true).truncate(false).open(path) {
            // A holder may have removed the folder after it was created here and before the file was.
            Err(error) if error.kind() == std::io::ErrorKind::NotFound && tries < TRIES => tries += 1,
            opened => return opened.map_err(|error| FileError::new(Operation::Lock, path, error)),
        }
    }
}

/// Refuses a path that is not an ordinary file: opening a pipe would wait, and a link would lead elsewhere.
fn refuse_special(path: &Path) -> Result<(), FileError> {
    match fs::symlink_metadata(path) {
        Ok(found) if !found.is_file() => {
            let why = std::io::Error::other("it is no ordinary file but a link, a pipe or a folder; remove it");
            Err(FileError::new(Operation::Lock, path, why))
        }
        _ => Ok(()),
    }
}

/// Returns whether a [`FileLock`] on a file is held, in this process or another.
pub fn is_locked(path: &Path) -> bool {
    // A shared lock, so that two simultaneous checks do not take each other for a holder.
    refuse_special(path).is_ok()
        && File::open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_has_one_holder_until_it_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("below/file.lock");
        assert!(!is_locked(&path));
        let lock = FileLock::acquire(&path).unwrap();
        assert!(is_locked(&path));
        let error = FileLock::acquire(&path).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("{} is in use by another program", path.display())
        );
        drop(lock);
        assert!(!is_locked(&path));
        let lock = FileLock::acquire(&path).unwrap();
        lock.remove();
        assert!(!path.exists());
        FileLock::acquire(&path).unwrap();
    }

    #[test]
    fn waiting_for_a_lock_ends_when_it_is_released() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file.lock");
        let first = FileLock::wait(&path, &mut || unreachable!("nobody holds it"))
            .unwrap()
            .unwrap();
        std::thread::scope(|scope| {
            let (told, waits) = std::sync::mpsc::channel();
            let waiting = path.clone();
            scope.spawn(move || {
                let second = FileLock::wait(&waiting, &mut || true).unwrap().unwrap();
                told.send(()).unwrap();
                drop(second);
            });
            let early = waits.recv_timeout(std::time::Duration::from_millis(50));
            assert!(early.is_err(), "it is held");
            drop(first);
            waits.recv().unwrap();
        });
        assert!(!is_locked(&path));
    }

    /// On Windows, a file that is open keeps its name.
    #[cfg(unix)]
    #[test]
    fn whoever_waits_for_a_lock_whose_folder_is_removed_holds_one_that_others_see() {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("own");
        let path = own.join("file.lock");
        let first = FileLock::acquire(&path).unwrap();
        std::thread::scope(|scope| {
            let (waits, waiting) = std::sync::mpsc::channel();
            let (holds, held) = std::sync::mpsc::channel();
            let wanted = path.clone();
            scope.spawn(move || {
                let mut goes_on = || waits.send(()).is_ok();
                holds
                    .send(FileLock::wait(&wanted, &mut goes_on).unwrap().unwrap())
                    .unwrap();
            });
            waiting.recv().unwrap();
            fs::remove_file(&path).unwrap();
            fs::remove_dir(&own).unwrap();
            drop(first);
            let second = held.recv().unwrap();
            assert!(path.is_file() && is_locked(&path));
            drop(second);
        });
    }

    #[test]
    fn waiting_for_a_lock_can_be_canceled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file.lock");
        let _held = FileLock::acquire(&path).unwrap();
        let mut looks = 0;
        let mut goes_on = || {
            looks += 1;
            looks < 3
        };
        assert!(FileLock::wait(&path, &mut goes_on).unwrap().is_none());
        assert_eq!(looks, 3);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_or_a_pipe_cannot_be_a_lock() {
        let folder = tempfile::tempdir().unwrap();
        let [link, pipe, elsewhere] = ["link.lock", "pipe.lock", "elsewhere"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink(&elsewhere, &link).unwrap();
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        for path in [&link, &pipe] {
            let told = FileLock::wait(path, &mut || true).unwrap_err().to_string();
            let sentence = format!(
                "cannot lock {}: it is no ordinary file but a link, a pipe or a folder; remove it",
                path.display()
            );
            assert_eq!(told, sentence);
            assert!(matches!(FileLock::acquire(path), Err(LockError::Unavailable(_))));
            assert!(!is_locked(path));
        }
        assert!(!elsewhere.exists(), "nothing is made where the link leads");
    }

    #[test]
    fn a_lock_that_is_removed_while_others_try_it_has_only_one_holder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file.lock");
        let holders = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let Ok(lock) = FileLock::acquire(&path) else { continue };
                        assert_eq!(holders.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                        holders.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                        lock.remove();
                    }
                });
            }
        });
    }

    #[test]
    fn a_lock_that_cannot_be_created_is_unavailable() {
        let folder = tempfile::tempdir().unwrap();
        let error = FileLock::acquire(folder.path()).unwrap_err();
        assert!(matches!(error, LockError::Unavailable(_)), "{error}");
        assert!(!is_locked(folder.path()));
    }
}
