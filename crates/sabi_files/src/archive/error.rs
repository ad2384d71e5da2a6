//! Errors of writing and unpacking archives.

use std::path::PathBuf;

use thiserror::Error;

use super::names::NameFault;
use super::{MOST_BYTES, MOST_ENTRIES};
use crate::error::FileError;

/// Reason why an archive was not written or not unpacked. In that case no files are left behind. The text names no command
/// line flag: callers know which alternatives they offer.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// The file to be written exists.
    #[error("{} exists already", .0.display())]
    Exists(PathBuf),
    /// The folder to unpack into has files.
    #[error("the folder {} has files", .0.display())]
    FolderInUse(PathBuf),
    /// The path to unpack into is not a folder.
    #[error("{} is no folder", .0.display())]
    NoFolder(PathBuf),
    /// An entry has a name that is not valid on every system.
    #[error("the archive cannot hold '{name}': {fault}")]
    Name {
        /// The name.
        name: String,
        /// Reason for the refusal.
        fault: NameFault,
    },
    /// More entries than [`MOST_ENTRIES`].
    #[error("the archive has {0} entries, and at most {MOST_ENTRIES} are taken")]
    TooMany(usize),
    /// More bytes than [`MOST_BYTES`].
    #[error("the archive unpacks to {} MiB, and at most {} are taken", .0 >> 20, MOST_BYTES >> 20)]
    TooLarge(u64),
    /// A file that is packed or unpacked cannot be read.
    #[error("{} cannot be read: {why}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        why: String,
    },
    /// A file changed its length while it was packed.
    #[error("{} was changed while it was packed", .0.display())]
    Changed(PathBuf),
    /// The file is not an archive, or is damaged.
    #[error("{} is no zip archive, or a damaged one: {why}", path.display())]
    NoArchive {
        /// The file.
        path: PathBuf,
        /// Error of the reader.
        why: String,
    },
    /// Two entries have one name.
    #[error("the archive holds two files of one name")]
    SameNames,
    /// An entry is a link or a device.
    #[error(
        "'{0}' in the archive is no ordinary file but a link or a device, through which files elsewhere could be changed"
    )]
    NotPlain(String),
    /// An entry that the caller refuses.
    #[error("'{name}' in the archive is not unpacked: {why}")]
    Unwanted {
        /// The entry.
        name: String,
        /// Reason given by the caller.
        why: String,
    },
    /// Two entries share bytes of the archive, with which a small archive can claim a huge content.
    #[error("'{0}' in the archive is damaged: it shares its bytes with another entry")]
    Overlapping(String),
    /// An entry is locked with a password.
    #[error("'{0}' in the archive is encrypted")]
    Encrypted(String),
    /// An entry is damaged, or longer or shorter than the archive claims.
    #[error("'{name}' in the archive is damaged: {why}")]
    Damaged {
        /// The entry.
        name: String,
        /// Fault of the entry.
        why: String,
    },
    /// The archive could not be created.
    #[error("the archive cannot be made: {0}")]
    Unmade(String),
    /// The disk refuses.
    #[error(transparent)]
    Disk(#[from] FileError),
    /// The user canceled the operation.
    #[error("stopped")]
    Canceled,
}
