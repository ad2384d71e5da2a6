//! Unpacks untrusted archives: first into a temporary folder beside the target, from which the files are then moved.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, Read, Seek};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use zip::ZipArchive;
use zip::read::ZipFile;

use super::error::ArchiveError;
use super::names::{EntryNames, check};
use super::{MOST_BYTES, MOST_ENTRIES};
use crate::disk::{Disk, DiskStep};
use crate::error::{FileError, Operation, io_reason};
use crate::temporary::{TemporaryFolder, is_temporary_name, sweep_folders, temporary_folder_in};
use crate::whole::{Durability, create_folder, folder_of, sync_folder};

/// Decides whether an archive may have an entry with this name. The error is a clause.
pub type Accepts<'a> = &'a dyn Fn(&str) -> Result<(), String>;

/// Number of bytes that are copied at a time, between two checks for cancellation.
const CHUNK: u64 = 1 << 20;
/// Threads that wait for the disk.
const SYNCERS: usize = 8;
/// Pause between two checks for cancellation.
const BETWEEN_LOOKS: Duration = Duration::from_millis(2);
/// Bits for the kind of a file in Unix permissions, and the two kinds that are unpacked.
const KIND_BITS: u32 = 0o170_000;
const PLAIN_FILE: u32 = 0o100_000;
const FOLDER: u32 = 0o040_000;

/// An archive that was unpacked into a temporary folder. Dropping it removes all files.
#[derive(Debug)]
pub struct UnpackedArchive {
    disk: Disk,
    temporary: TemporaryFolder,
    target: PathBuf,
    names: Vec<String>,
}

/// An entry as declared by the archive.
struct DeclaredEntry {
    name: String,
    bytes: u64,
    is_folder: bool,
}

/// Bytes of an archive that belong to an entry: its header and its data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct ByteRange {
    start: u64,
    /// First byte after the range.
    end: u64,
    /// Number of the entry.
    entry: usize,
}

impl UnpackedArchive {
    /// Unpacks an archive for a target folder that does not exist or is empty. Nothing that the archive claims is trusted:
    /// all names and sizes are checked before the first file is written, and sizes are checked again during writing. Names
    /// that the caller does not accept are refused.
    ///
    /// # Errors
    /// See [`ArchiveError`]; nothing is left behind.
    pub fn read(
        archive: &Path,
        target: &Path,
        accepts: Accepts<'_>,
        is_canceled: &dyn Fn() -> bool,
    ) -> Result<UnpackedArchive, ArchiveError> {
        UnpackedArchive::read_on(&Disk::default(), archive, target, accepts, is_canceled)
    }

    /// Unpacks an archive on a disk, as [`UnpackedArchive::read`] does.
    pub(crate) fn read_on(
        disk: &Disk,
        archive: &Path,
        target: &Path,
        accepts: Accepts<'_>,
        is_canceled: &dyn Fn() -> bool,
    ) -> Result<UnpackedArchive, ArchiveError> {
        let is_there = is_empty_folder_but(target, is_temporary_name)?;
        let unread = |why: String| ArchiveError::Unread {
            path: archive.to_owned(),
            why,
        };
        let known = fs::metadata(archive).map_err(|error| unread(reason(&error)))?;
        if !known.is_file() {
            return Err(unread("it is no ordinary file".to_owned()));
        }
        let file = File::open(archive).map_err(|error| unread(reason(&error)))?;
        let no_archive = |error: zip::result::ZipError| ArchiveError::NoArchive {
            path: archive.to_owned(),
            why: error.to_string(),
        };
        let mut opened = ZipArchive::new(BufReader::new(file)).map_err(no_archive)?;
        let claims = claims(&mut opened, accepts)?;
        let place = if is_there { target } else { existing_folder(target) };
        // A killed process may have left parts of an archive.
        sweep_folders(place);
        if is_there {
            is_empty_folder_but(target, |_| false)?;
        }
        let temporary = temporary_folder_in(disk, place);
        let mut unpacked = UnpackedArchive {
            disk: disk.clone(),
            temporary: temporary.map_err(|error| FileError::new(Operation::Write, place, error))?,
            target: target.to_owned(),
            names: Vec::new(),
        };
        for (index, claim) in claims.into_iter().enumerate().filter(|(_, claim)| !claim.is_folder) {
            let mut entry = opened
                .by_index(index)
                .map_err(|error| damaged(&claim.name, error.to_string()))?;
            unpacked.write(&mut entry, &claim, is_canceled)?;
            unpacked.names.push(claim.name);
        }
        unpacked.names.sort();
        unpacked.sync_files(is_canceled)?;
        unpacked.sync_folders()?;
        Ok(unpacked)
    }

    /// Names of the files, sorted.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the folder that contains the files until they are moved to the target.
    pub fn folder(&self) -> &Path {
        self.temporary.path()
    }

    /// Moves the files to the target folder durably.
    ///
    /// # Errors
    /// The folder has got files meanwhile, or the disk refuses; nothing is left behind, unless the operation is
    /// [`Operation::SyncFolder`]: then all files are in place.
    pub fn commit(self) -> Result<(), ArchiveError> {
        let own = self.temporary.path().file_name();
        if is_empty_folder_but(&self.target, |name| own == Some(OsStr::new(name)))? {
            return self.move_into();
        }
        let above = folder_of(&self.target);
        create_folder(&self.disk, above, Durability::Synced)?;
        let from = self.temporary.path();
        let renamed = self.disk.rename(from, &self.target, || fs::rename(from, &self.target));
        renamed.map_err(|error| FileError::new(Operation::Replace, &self.target, error))?;
        // The temporary folder was renamed, so it must not be removed.
        self.temporary.keep();
        Ok(sync_folder(&self.disk, above)?)
    }

    /// Moves the files into an existing folder, which may be the current folder of a shell or the root of a disk. If the process is killed
    /// during this, some files have been moved, each of them complete, and the others are in the temporary folder.
    fn move_into(self) -> Result<(), ArchiveError> {
        let rename = |from: &Path, to: &Path| self.disk.rename(from, to, || fs::rename(from, to));
        let first = |name: &String| name.split('/').next().unwrap_or(name).to_owned();
        let tops: BTreeSet<String> = self.names.iter().map(first).collect();
        let mut moved: Vec<(PathBuf, PathBuf)> = Vec::new();
        for top in tops {
            let [from, to] = [self.temporary.path(), &self.target].map(|folder| folder.join(&top));
            if let Err(error) = rename(&from, &to) {
                for (from, to) in moved {
                    // Move the file back, so that it is removed together with the others.
                    let _ = rename(&to, &from);
                }
                return Err(FileError::new(Operation::Replace, &to, error).into());
            }
            moved.push((from, to));
        }
        Ok(sync_folder(&self.disk, &self.target)?)
    }

    /// Syncs the folders, so that the names of the files are on the disk.
    fn sync_folders(&self) -> Result<(), ArchiveError> {
        let root = self.temporary.path();
        let above = |name: &String| {
            Path::new(name)
                .ancestors()
                .skip(1)
                .map(|folder| root.join(folder))
                .collect::<Vec<_>>()
        };
        let folders: BTreeSet<PathBuf> = self.names.iter().flat_map(above).collect();
        for folder in folders {
            // Normalize the path: `root.join("")` ends in a separator.
            let folder: PathBuf = folder.components().collect();
            sync_folder(&self.disk, &folder)?;
        }
        Ok(())
    }

    /// Writes an entry. It must have exactly the size that the archive declares.
    fn write<R: Read + Seek>(
        &self,
        entry: &mut ZipFile<'_, R>,
        claim: &DeclaredEntry,
        is_canceled: &dyn Fn() -> bool,
    ) -> Result<(), ArchiveError> {
        let path = self.temporary.path().join(&claim.name);
        // Folders are synced later, together with the names of their files.
        create_folder(&self.disk, folder_of(&path), Durability::Unsynced)?;
        let refused = |error| match io::Error::kind(&error) {
            // The file system treats two names as the same that were considered distinct.
            io::ErrorKind::AlreadyExists => ArchiveError::SameNames,
            _ => FileError::new(Operation::Write, &self.target.join(&claim.name), error).into(),
        };
        let open = || OpenOptions::new().write(true).create_new(true).open(&path);
        let mut file = self.disk.step(DiskStep::CreateFile, &path, open).map_err(refused)?;
        let mut limited = entry.take(claim.bytes.saturating_add(1));
        let mut chunk = vec![0; claim.bytes.min(CHUNK - 1) as usize + 1];
        let mut written = 0;
        loop {
            if is_canceled() {
                return Err(ArchiveError::Canceled);
            }
            // The reader compares the checksum at the end of the entry.
            let read = limited
                .read(&mut chunk)
                .map_err(|error| damaged(&claim.name, error.to_string()))?;
            written += read as u64;
            if written > claim.bytes {
                let why = format!(
                    "it unpacks to more than the {} bytes that the archive claims",
                    claim.bytes
                );
                return Err(damaged(&claim.name, why));
            }
            if read == 0 {
                break;
            }
            let written = self.disk.write(DiskStep::Write, &path, &mut file, &chunk[..read]);
            written.map_err(refused)?;
        }
        if written < claim.bytes {
            let why = format!(
                "it ends after {written} of the {} bytes that the archive claims",
                claim.bytes
            );
            return Err(damaged(&claim.name, why));
        }
        Ok(())
    }

    /// Syncs the bytes of all files. This is done after all files were written, when most bytes are on the disk already. Several
    /// threads wait for the disk, which then syncs many files at once: one after the other takes fifty times as long.
    fn sync_files(&self, is_canceled: &dyn Fn() -> bool) -> Result<(), ArchiveError> {
        let (next, ends) = (AtomicUsize::new(0), AtomicBool::new(false));
        let sync_next = || {
            while !ends.load(Ordering::Relaxed) {
                let Some(name) = self.names.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                if let Err(error) = self.sync_file(name) {
                    ends.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
            Ok(())
        };
        thread::scope(|scope| {
            let syncing: Vec<_> = (0..SYNCERS.min(self.names.len()))
                .map(|_| scope.spawn(sync_next))
                .collect();
            while !syncing.iter().all(|thread| thread.is_finished()) {
                if is_canceled() {
                    ends.store(true, Ordering::Relaxed);
                }
                thread::sleep(BETWEEN_LOOKS);
            }
            // A panic of a thread goes on here.
            let joined = syncing
                .into_iter()
                .map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            joined.collect::<Result<Vec<()>, ArchiveError>>()
        })?;
        match is_canceled() {
            true => Err(ArchiveError::Canceled),
            false => Ok(()),
        }
    }

    /// Writes the bytes of a file to the disk.
    fn sync_file(&self, name: &str) -> Result<(), ArchiveError> {
        let path = self.temporary.path().join(name);
        // Some systems sync only what may be written to.
        let open = || OpenOptions::new().write(true).open(&path);
        let synced = self
            .disk
            .step(DiskStep::Sync, &path, || open().and_then(|file| file.sync_all()));
        synced.map_err(|error| FileError::new(Operation::Write, &self.target.join(name), error).into())
    }
}

/// Checks everything that an archive claims.
fn claims<R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    accepts: Accepts<'_>,
) -> Result<Vec<DeclaredEntry>, ArchiveError> {
    if archive.len() > MOST_ENTRIES {
        return Err(ArchiveError::TooMany(archive.len()));
    }
    // Of two entries with the same name, this reader would keep the last one, while other programs keep the first.
    if archive.has_duplicate_names() {
        return Err(ArchiveError::SameNames);
    }
    let mut names = EntryNames::default();
    let mut claims = Vec::new();
    let mut total = 0_u64;
    let mut ranges = Vec::new();
    for index in 0..archive.len() {
        let entry = archive
            .by_index_raw(index)
            .map_err(|error| damaged(&format!("entry {index}"), error.to_string()))?;
        let name = entry
            .name()
            .map_err(|error| damaged(&format!("entry {index}"), error.to_string()))?
            .into_owned();
        let refused = |fault| ArchiveError::Name {
            name: name.clone(),
            fault,
        };
        match name.strip_suffix('/') {
            Some(folder) => check(folder).map_err(refused)?,
            None => names.add(&name).map_err(refused)?,
        }
        let kind = entry.unix_mode().map_or(0, |mode| mode & KIND_BITS);
        let is_folder = name.ends_with('/');
        if entry.is_symlink() || !matches!((kind, is_folder), (0, _) | (PLAIN_FILE, false) | (FOLDER, true)) {
            return Err(ArchiveError::NotPlain(name));
        }
        if entry.encrypted() {
            return Err(ArchiveError::Encrypted(name));
        }
        if !is_folder {
            accepts(&name).map_err(|why| ArchiveError::Unwanted {
                name: name.clone(),
                why,
            })?;
        }
        ranges.push(ByteRange {
            start: entry.header_start(),
            end: entry
                .data_start()
                .unwrap_or(entry.header_start()) // An entry without data consists only of its header.
                .saturating_add(entry.compressed_size()),
            entry: claims.len(),
        });
        total = total.saturating_add(entry.size());
        claims.push(DeclaredEntry {
            bytes: entry.size(),
            is_folder,
            name,
        });
    }
    if total > MOST_BYTES {
        return Err(ArchiveError::TooLarge(total));
    }
    ranges.sort();
    match ranges.windows(2).find(|pair| pair[1].start < pair[0].end) {
        Some(pair) => Err(ArchiveError::Overlapping(claims[pair[1].entry].name.clone())),
        None => Ok(claims),
    }
}

fn damaged(name: &str, why: String) -> ArchiveError {
    ArchiveError::Damaged {
        name: name.to_owned(),
        why,
    }
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => io_reason(error),
    }
}

/// Returns true if the folder exists, and false if it does not.
///
/// # Errors
/// It has files whose names are not those of left-overs, or is no folder.
fn is_empty_folder_but(target: &Path, is_left: impl Fn(&str) -> bool) -> Result<bool, ArchiveError> {
    let entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(target).is_err() => {
            return Ok(false);
        }
        Err(_) => return Err(ArchiveError::NoFolder(target.to_owned())),
    };
    let is_other =
        |entry: io::Result<fs::DirEntry>| entry.is_ok_and(|entry| !entry.file_name().to_str().is_some_and(&is_left));
    match entries.into_iter().any(is_other) {
        true => Err(ArchiveError::FolderInUse(target.to_owned())),
        false => Ok(true),
    }
}

/// Returns the nearest existing parent of a path. The temporary folder is created there, so that no folder is created if unpacking fails.
fn existing_folder(target: &Path) -> &Path {
    let mut folder = folder_of(target);
    while !folder.is_dir() && folder.file_name().is_some() {
        folder = folder_of(folder);
    }
    folder
}
