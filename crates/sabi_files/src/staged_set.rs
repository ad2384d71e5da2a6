//! Sets of files that are put in place together.

mod package;

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{fs, mem};

use tempfile::{NamedTempFile, TempPath};
use thiserror::Error;

use crate::disk::{Disk, DiskStep};
use crate::error::{FileError, Operation};
use crate::temporary::{claim, sweep, temporary_names};
use crate::whole::{Durability, WholeFile, create_folder, folder_of, missing_folders, replace_error, sync_folder};

/// Start of the temporary names that replaced files get until a commit has succeeded.
const EARLIER_PREFIX: &str = ".sabi-earlier-";

/// Files of one folder that are written under temporary names and put in place together by [`StagedSet::commit`]. A file that has the same
/// bytes already is not touched and keeps its time stamp. Dropping the set removes what it has written. A process that is killed leaves
/// hidden `.tmp` files but never an incomplete target; the next set in the folder removes these files.
#[derive(Debug)]
pub struct StagedSet {
    disk: Disk,
    folder: PathBuf,
    /// Final files, in the order of staging.
    files: Vec<(PathBuf, StagedFile)>,
    /// Names in use, in a form that is equal for names that differ only in case.
    names: BTreeSet<OsString>,
    /// Canonical paths of files that must not be replaced.
    protected: BTreeSet<PathBuf>,
    /// Folders that the set has created, outermost first. Empty ones are removed on drop.
    created: Vec<PathBuf>,
}

/// Failure to write a set of files.
#[derive(Debug, Error)]
pub enum StagedError {
    /// A folder or temporary file could not be written. No target has changed.
    #[error(transparent)]
    File(#[from] FileError),
    /// The target is a file that the same work reads.
    #[error("{} is read by the work that would replace it", path.display())]
    Protected {
        /// Target that was refused.
        path: PathBuf,
    },
    /// The target is a device, pipe or socket.
    #[error("{} is no ordinary file", path.display())]
    NotAFile {
        /// Target that was refused.
        path: PathBuf,
    },
    /// Two files of the set have the same name.
    #[error("two files would be written to {}", Path::new(file_name).display())]
    SameName {
        /// Name without folder.
        file_name: OsString,
    },
    /// A complete file could not be renamed to its final name.
    #[error("{error}; {replaced} of {total} files are new")]
    Commit {
        /// Rename that failed.
        error: FileError,
        /// Number of files that are new in spite of the failure, because the file system could not restore the earlier
        /// ones; 0 if every file is unchanged.
        replaced: usize,
        /// Files of the set.
        total: usize,
    },
}

/// A file of a set.
#[derive(Debug)]
enum StagedFile {
    /// Written, under a temporary name.
    New(NamedTempFile),
    /// In place already, with the same bytes.
    Unchanged(FileStamp),
}

/// Properties of a file that reveal later changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FileStamp {
    bytes: u64,
    modified: Option<SystemTime>,
}

impl FileStamp {
    /// Returns the properties of an ordinary file; `None` for anything else, including a link.
    fn of(path: &Path) -> Option<FileStamp> {
        let found = fs::symlink_metadata(path).ok().filter(fs::Metadata::is_file)?;
        Some(FileStamp {
            bytes: found.len(),
            modified: found.modified().ok(),
        })
    }

    /// Returns the properties of a file if it has exactly these bytes.
    fn of_same(path: &Path, bytes: &[u8]) -> Option<FileStamp> {
        let stamp = FileStamp::of(path).filter(|stamp| stamp.bytes == bytes.len() as u64)?;
        let is_same = fs::read(path).is_ok_and(|found| found == bytes);
        is_same.then_some(stamp)
    }
}

/// Earlier state of a target, which is restored if a later file of the set fails.
enum EarlierState {
    /// No file existed.
    Missing,
    /// The set did not change it.
    Kept,
    /// The earlier file was kept under a second name.
    Linked {
        name: TempPath,
        /// Open handle that protects the second name from being removed as a left-over.
        _claim: Option<File>,
    },
    /// The earlier state cannot be restored: the file system does not support hard links.
    Unknown,
}

impl StagedSet {
    /// Creates the folder if it is missing and checks that files can be written there, so that an error occurs before long
    /// work and not after it.
    ///
    /// # Errors
    /// The folder cannot be created or written to.
    pub fn create(folder: &Path) -> Result<StagedSet, StagedError> {
        StagedSet::create_on(&Disk::default(), folder)
    }

    /// Creates a set on a disk, as [`StagedSet::create`] does.
    ///
    /// # Errors
    /// The folder cannot be created or written to.
    pub fn create_on(disk: &Disk, folder: &Path) -> Result<StagedSet, StagedError> {
        // An empty path means the current folder.
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        let created = missing_folders(folder).into_iter().map(Path::to_owned).collect();
        let mut set = StagedSet {
            disk: disk.clone(),
            folder: folder.to_owned(),
            files: Vec::new(),
            names: BTreeSet::new(),
            protected: BTreeSet::new(),
            created,
        };
        create_folder(disk, folder, Durability::Unsynced)?;
        if !disk.has_ended() {
            sweep(folder);
        }
        set.stage("probe", b"probe")?;
        set.files.clear();
        set.names.clear();
        Ok(set)
    }

    /// Folder of the files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns whether a file with this name, ignoring case, is staged.
    pub fn contains(&self, file_name: impl AsRef<OsStr>) -> bool {
        self.names.contains(&case_folded(file_name.as_ref()))
    }

    /// Refuses to replace these files from now on, because they are inputs of the work whose results are in the set.
    pub fn protect(&mut self, inputs: impl IntoIterator<Item = PathBuf>) {
        // A missing file cannot be replaced, so it needs no protection.
        let real = inputs.into_iter().filter_map(|path| path.canonicalize().ok());
        self.protected.extend(real);
    }

    /// Checks that a file may be written under a plain name.
    ///
    /// # Errors
    /// The name contains a folder, or the target is protected or not an ordinary file.
    pub fn check(&self, file_name: impl AsRef<OsStr>) -> Result<(), StagedError> {
        let file_name = file_name.as_ref();
        let target = self.folder.join(file_name);
        if Path::new(file_name).file_name() != Some(file_name) {
            let error = FileError::new(Operation::Write, &target, ErrorKind::InvalidFilename.into());
            return Err(error.into());
        }
        if target.canonicalize().is_ok_and(|real| self.protected.contains(&real)) {
            return Err(StagedError::Protected { path: target });
        }
        if fs::metadata(&target).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
            return Err(StagedError::NotAFile { path: target });
        }
        Ok(())
    }

    /// Writes a file completely under a temporary name. `file_name` contains no folder.
    ///
    /// # Errors
    /// The name is refused (see [`StagedSet::check`]) or used twice, or the disk refuses the bytes.
    pub fn stage(&mut self, file_name: impl AsRef<OsStr>, bytes: &[u8]) -> Result<(), StagedError> {
        self.stage_like(file_name, bytes, None)
    }

    /// Stages a copy of a file like [`StagedSet::stage`], with the permissions and the time of the original.
    ///
    /// # Errors
    /// Those of [`StagedSet::stage`].
    pub fn stage_like(
        &mut self,
        file_name: impl AsRef<OsStr>,
        bytes: &[u8],
        like: Option<&fs::Metadata>,
    ) -> Result<(), StagedError> {
        let target = self.free_target(file_name.as_ref())?;
        if let Some(stamp) = FileStamp::of_same(&target, bytes) {
            self.add(target, StagedFile::Unchanged(stamp));
            return Ok(());
        }
        let mut file = WholeFile::create_on(&self.disk, &target)?;
        file.write(bytes)?;
        if let Some(like) = like {
            // Some file systems store neither; only the bytes matter.
            let _ = file.as_file_mut().set_permissions(like.permissions());
            let _ = like.modified().and_then(|time| file.as_file_mut().set_modified(time));
        }
        file.sync()?;
        let (target, file) = file.into_parts();
        self.add(target, StagedFile::New(file));
        Ok(())
    }

    /// Returns the target for a name, after checking that it may be written and that no other file of the set has it.
    fn free_target(&self, file_name: &OsStr) -> Result<PathBuf, StagedError> {
        self.check(file_name)?;
        if self.contains(file_name) {
            let file_name = file_name.to_owned();
            return Err(StagedError::SameName { file_name });
        }
        Ok(self.folder.join(file_name))
    }

    fn add(&mut self, target: PathBuf, file: StagedFile) {
        // Targets always have a file name.
        let file_name = target.file_name().unwrap_or_default();
        self.names.insert(case_folded(file_name));
        self.files.push((target, file));
    }

    /// Puts all files in place and returns their paths in the order of staging. If a file cannot be put in place, the
    /// earlier content of the files before it is restored, as far as the file system can do that.
    ///
    /// # Errors
    /// A file could not be put in place; [`StagedError::Commit`] contains the number of files that are new in spite of the failure.
    pub fn commit(self) -> Result<Vec<PathBuf>, StagedError> {
        self.commit_with(|file, target| file.persist(target).map(drop).map_err(|refused| refused.error))
    }

    fn commit_with(
        mut self,
        mut place: impl FnMut(NamedTempFile, &Path) -> io::Result<()>,
    ) -> Result<Vec<PathBuf>, StagedError> {
        let total = self.files.len();
        let refused = |target: &Path, error, replaced| StagedError::Commit {
            error: FileError::new(Operation::Replace, target, error),
            replaced,
            total,
        };
        // Find predictable failures before the first file is changed.
        let is_folder = |target: &Path| fs::symlink_metadata(target).is_ok_and(|found| found.is_dir());
        if let Some((target, _)) = self.files.iter().find(|(target, _)| is_folder(target)) {
            return Err(refused(target, ErrorKind::IsADirectory.into(), 0));
        }
        let changed = self.files.iter().find(|(target, file)| match file {
            StagedFile::Unchanged(stamp) => FileStamp::of(target) != Some(*stamp),
            StagedFile::New(_) => false,
        });
        if let Some((target, _)) = changed {
            let error = io::Error::other("another program has changed it meanwhile");
            return Err(refused(target, error, 0));
        }
        let mut placed: Vec<(PathBuf, EarlierState)> = Vec::with_capacity(total);
        for (target, file) in mem::take(&mut self.files) {
            let StagedFile::New(file) = file else {
                placed.push((target, EarlierState::Kept));
                continue;
            };
            let earlier = earlier(&self.disk, &self.folder, &target);
            let from = file.path().to_owned();
            if let Err(error) = self.disk.rename(&from, &target, || place(file, &target)) {
                let error = replace_error(&target, error);
                let replaced = restore(&self.disk, placed);
                if replaced > 0 {
                    self.created.clear();
                }
                return Err(refused(&target, error, replaced));
            }
            placed.push((target, earlier));
        }
        let created = mem::take(&mut self.created);
        let folders = created.iter().map(|folder| folder_of(folder));
        for folder in folders.chain([self.folder.as_path()]) {
            sync_folder(&self.disk, folder).map_err(|error| StagedError::Commit {
                error,
                replaced: total,
                total,
            })?;
        }
        Ok(placed.into_iter().map(|(target, _)| target).collect())
    }
}

impl Drop for StagedSet {
    fn drop(&mut self) {
        // Remove temporary files first: only empty folders can be removed.
        self.files.clear();
        if self.disk.has_ended() {
            return;
        }
        for folder in self.created.iter().rev() {
            // This fails, as intended, if another program has put something into the folder.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Gives an earlier file a second name, under which it is kept when it is replaced.
fn earlier(disk: &Disk, folder: &Path, target: &Path) -> EarlierState {
    if fs::symlink_metadata(target).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        return EarlierState::Missing;
    }
    let mut names = temporary_names(OsStr::new(EARLIER_PREFIX));
    names.disable_cleanup(disk.keeps_temporaries());
    let linked = names.make_in(folder, |name| {
        disk.step(DiskStep::Link, name, || fs::hard_link(target, name))
    });
    linked.map_or(EarlierState::Unknown, |linked| {
        let name = linked.into_temp_path();
        // Without this handle the file can still be restored, unless another set in the folder removes it as a left-over.
        let claim = File::open(&name).ok().filter(|file| claim(file, &name));
        EarlierState::Linked { name, _claim: claim }
    })
}

/// Restores earlier files, starting with the last one. Returns the number of files that could not be restored.
fn restore(disk: &Disk, placed: Vec<(PathBuf, EarlierState)>) -> usize {
    let restored = placed.into_iter().rev().map(|(target, earlier)| match earlier {
        EarlierState::Kept => true,
        EarlierState::Missing => disk.remove(&target).is_ok(),
        EarlierState::Linked { name, .. } => {
            let from = name.to_path_buf();
            let restored = disk.rename(&from, &target, || {
                name.persist(&target).map_err(|refused| refused.error)
            });
            restored.is_ok()
        }
        EarlierState::Unknown => false,
    });
    restored.filter(|is_restored| !is_restored).count()
}

/// Returns the lower-case form of a name. A name that is not Unicode is returned unchanged.
fn case_folded(file_name: &OsStr) -> OsString {
    file_name
        .to_str()
        .map_or_else(|| file_name.to_owned(), |name| name.to_lowercase().into())
}

#[cfg(test)]
mod tests;
