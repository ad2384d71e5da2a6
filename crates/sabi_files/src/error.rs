//! Errors of disk operations.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use thiserror::Error;

/// Failed disk operation with its path and the system's error. The text names no remedy: callers know which alternatives they offer.
#[derive(Debug, Error)]
#[error("{operation} {}: {}", path.display(), io_reason(source))]
pub struct FileError {
    /// Operation that failed.
    pub operation: Operation,
    /// File or folder of the operation.
    pub path: PathBuf,
    /// Error of the system.
    pub source: io::Error,
}

/// Kind of disk operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Creation of a folder.
    CreateFolder,
    /// Listing of a folder.
    List,
    /// Writing a complete file. The earlier file is unchanged.
    Write,
    /// Writing at the end of a file.
    Append,
    /// Renaming a complete temporary file to its final name. The earlier file is unchanged.
    Replace,
    /// Syncing the entries of a folder. The new file is in place, but a power failure may undo that.
    SyncFolder,
    /// Locking of a file.
    Lock,
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Operation::CreateFolder => "cannot create the folder",
            Operation::List => "cannot list the folder",
            Operation::Write => "cannot write",
            Operation::Append => "cannot append to",
            Operation::Replace => "cannot replace",
            Operation::SyncFolder => "cannot make sure that new files survive a power failure in",
            Operation::Lock => "cannot lock",
        })
    }
}

impl FileError {
    /// Creates the error of an operation on a path.
    pub(crate) fn new(operation: Operation, path: &Path, source: io::Error) -> FileError {
        FileError {
            operation,
            path: path.to_owned(),
            source,
        }
    }

    /// Returns the reason for the failure, as a clause without the path.
    pub fn reason(&self) -> String {
        io_reason(&self.source)
    }

    /// Returns the kind of the system's error.
    pub fn kind(&self) -> io::ErrorKind {
        self.source.kind()
    }
}

/// Returns why a file cannot be written, as a clause without error numbers of the system.
pub fn io_reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::PermissionDenied => "you have no permission".into(),
        io::ErrorKind::StorageFull => "the disk is full".into(),
        io::ErrorKind::QuotaExceeded => "your disk quota is used up".into(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only".into(),
        io::ErrorKind::NotADirectory => "a part of its path is a file, not a folder".into(),
        io::ErrorKind::AlreadyExists => "a file of that name is in the way".into(),
        io::ErrorKind::IsADirectory => "a folder of that name is in the way".into(),
        io::ErrorKind::NotFound => "its folder does not exist".into(),
        io::ErrorKind::InvalidFilename => "its name is not allowed there".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_operation_the_path_and_the_reason() {
        let error = |operation, kind: io::ErrorKind| FileError::new(operation, Path::new("out/a.png"), kind.into());
        for (operation, kind, sentence) in [
            (
                Operation::Write,
                io::ErrorKind::StorageFull,
                "cannot write out/a.png: the disk is full",
            ),
            (
                Operation::CreateFolder,
                io::ErrorKind::ReadOnlyFilesystem,
                "cannot create the folder out/a.png: the disk is read-only",
            ),
            (
                Operation::Replace,
                io::ErrorKind::IsADirectory,
                "cannot replace out/a.png: a folder of that name is in the way",
            ),
            (
                Operation::Lock,
                io::ErrorKind::PermissionDenied,
                "cannot lock out/a.png: you have no permission",
            ),
        ] {
            assert_eq!(error(operation, kind).to_string(), sentence);
        }
    }
}
