//! Archives that have the same bytes for the same files.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::error::ArchiveError;
use super::names::EntryNames;
use super::{MOST_BYTES, MOST_ENTRIES};
use crate::disk::Disk;
use crate::error::io_reason;
use crate::whole::part_writer::PartWriter;
use crate::whole::{Durability, WholeFile, create_folder, folder_of};

/// Extensions of files that are compressed already. Compressing them again takes long and saves nothing.
const COMPRESSED: [&str; 6] = ["png", "jpg", "jpeg", "webp", "exr", "zip"];
/// Number of bytes that are copied at a time, between two checks for cancellation.
const CHUNK: usize = 1 << 20;
/// Size from which an entry needs zip64 fields.
const LARGE: u64 = u32::MAX as u64;

/// Content of an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EntryContent {
    /// These bytes.
    Bytes(Vec<u8>),
    /// The bytes of a file.
    File(PathBuf),
}

/// Writes an archive with these entries. Returns the size of each entry in bytes, in the order of names. The same entries
/// give the same bytes: names are sorted, and times and permissions are always the same.
///
/// # Errors
/// The target exists and is not to be replaced, an entry cannot be read or has a name that some systems cannot hold, or the disk
/// refuses; the target is unchanged.
pub fn write_archive(
    target: &Path,
    entries: &BTreeMap<String, EntryContent>,
    replaces: bool,
    is_canceled: &dyn Fn() -> bool,
) -> Result<Vec<u64>, ArchiveError> {
    write_archive_on(&Disk::default(), target, entries, replaces, is_canceled)
}

/// Writes an archive on a disk, as [`write_archive`] does.
pub(crate) fn write_archive_on(
    disk: &Disk,
    target: &Path,
    entries: &BTreeMap<String, EntryContent>,
    replaces: bool,
    is_canceled: &dyn Fn() -> bool,
) -> Result<Vec<u64>, ArchiveError> {
    refuse_existing(target, replaces)?;
    if entries.len() > MOST_ENTRIES {
        return Err(ArchiveError::TooMany(entries.len()));
    }
    let mut names = EntryNames::default();
    for name in entries.keys() {
        let added = names.add(name);
        added.map_err(|fault| ArchiveError::Name {
            name: name.clone(),
            fault,
        })?;
    }
    let sizes: Vec<u64> = entries.values().map(size_of).collect::<Result<_, _>>()?;
    let total: u64 = sizes.iter().sum();
    if total > MOST_BYTES {
        return Err(ArchiveError::TooLarge(total));
    }
    create_folder(disk, folder_of(target), Durability::Synced)?;
    let mut whole = WholeFile::create_on(disk, target)?;
    let failure = OnceCell::new();
    let is_stopped = || is_canceled() || failure.get().is_some();
    let written = write_entries(PartWriter::new(&mut whole, &failure), entries, &sizes, &is_stopped);
    if let Some(error) = failure.into_inner() {
        return Err(error.into());
    }
    written?;
    // Another program may have created the file in the meantime.
    refuse_existing(target, replaces)?;
    whole.commit()?;
    Ok(sizes)
}

/// Writes all entries and returns their sizes in bytes.
fn write_entries(
    to: PartWriter<'_>,
    entries: &BTreeMap<String, EntryContent>,
    sizes: &[u64],
    is_stopped: &dyn Fn() -> bool,
) -> Result<(), ArchiveError> {
    let mut archive = ZipWriter::new(BufWriter::new(to));
    for ((name, content), size) in entries.iter().zip(sizes) {
        write_entry(&mut archive, name, content, *size, is_stopped).map_err(|failure| match failure {
            EntryFailure::Archive(error) => error,
            EntryFailure::Zip(error) => unmade(error),
        })?;
    }
    let finished = archive.finish().map_err(unmade)?;
    let flushed = finished.into_inner();
    flushed.map(drop).map_err(|error| unmade(error.into_error().into()))
}

fn refuse_existing(target: &Path, replaces: bool) -> Result<(), ArchiveError> {
    match !replaces && fs::symlink_metadata(target).is_ok() {
        true => Err(ArchiveError::Exists(target.to_owned())),
        false => Ok(()),
    }
}

/// Failure of one entry: an error of this crate, or of the zip writer.
enum EntryFailure {
    Archive(ArchiveError),
    Zip(ZipError),
}

impl From<ArchiveError> for EntryFailure {
    fn from(error: ArchiveError) -> EntryFailure {
        EntryFailure::Archive(error)
    }
}

impl From<ZipError> for EntryFailure {
    fn from(error: ZipError) -> EntryFailure {
        EntryFailure::Zip(error)
    }
}

fn write_entry<W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    content: &EntryContent,
    size: u64,
    is_canceled: &dyn Fn() -> bool,
) -> Result<(), EntryFailure> {
    archive.start_file(name, options(name, size))?;
    match content {
        EntryContent::Bytes(bytes) => archive.write_all(bytes).map_err(ZipError::from)?,
        EntryContent::File(path) => {
            let mut file = File::open(path).map_err(|error| unread(path, &error))?.take(size + 1);
            let mut chunk = vec![0; CHUNK];
            let mut copied = 0;
            loop {
                if is_canceled() {
                    return Err(ArchiveError::Canceled.into());
                }
                let read = file.read(&mut chunk).map_err(|error| unread(path, &error))?;
                if read == 0 {
                    break;
                }
                copied += read as u64;
                archive.write_all(&chunk[..read]).map_err(ZipError::from)?;
            }
            if copied != size {
                return Err(ArchiveError::Changed(path.clone()).into());
            }
        }
    }
    Ok(())
}

/// Returns the options of an entry, which depend only on its name and size.
fn options(name: &str, size: u64) -> SimpleFileOptions {
    let ending = name
        .rsplit_once('.')
        .map_or("", |(_, ending)| ending)
        .to_ascii_lowercase();
    let method = match COMPRESSED.contains(&ending.as_str()) {
        true => CompressionMethod::Stored,
        false => CompressionMethod::Deflated,
    };
    SimpleFileOptions::default()
        .compression_method(method)
        .compression_level(None)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
        .large_file(size >= LARGE)
}

/// Returns the size of an entry. Pipes and devices are refused, since they may have no end.
fn size_of(content: &EntryContent) -> Result<u64, ArchiveError> {
    let path = match content {
        EntryContent::Bytes(bytes) => return Ok(bytes.len() as u64),
        EntryContent::File(path) => path,
    };
    let known = fs::metadata(path).map_err(|error| unread(path, &error))?;
    match known.is_file() {
        true => Ok(known.len()),
        false => Err(ArchiveError::Unread {
            path: path.clone(),
            why: "it is no ordinary file".to_owned(),
        }),
    }
}

fn unread(path: &Path, error: &std::io::Error) -> ArchiveError {
    ArchiveError::Unread {
        path: path.to_owned(),
        why: io_reason(error),
    }
}

fn unmade(error: ZipError) -> ArchiveError {
    ArchiveError::Unmade(match error {
        ZipError::Io(error) => io_reason(&error),
        error => error.to_string(),
    })
}
