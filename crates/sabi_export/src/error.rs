//! Errors of writing a texture set.

use std::io;
use std::path::{Path, PathBuf};

use sabi_files::{FileError, Operation, StagedError, io_reason};
use sabi_image::ImageError;
use thiserror::Error;

/// Error of writing a texture set. Existing files are unchanged, except those that [`ExportError::Replace`] counts. Its text
/// says what failed; the remedy follows from the variant, and is added by callers, which know what can be chosen.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The output folder does not exist and cannot be created.
    #[error("cannot create the folder {}: {}", path.display(), io_reason(source))]
    CreateFolder {
        /// The folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A file could not be written completely.
    #[error("cannot write {}, so nothing was changed: {}", path.display(), io_reason(source))]
    Write {
        /// The file that was to be.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A complete file could not be put in its place.
    #[error("cannot replace {}: {}; {replaced} of {total} files of this bake were put in place before it", path.display(), io_reason(source))]
    Replace {
        /// The file that was to be.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
        /// Files already in place.
        replaced: usize,
        /// Files of the bake.
        total: usize,
    },
    /// A file that is read would be replaced.
    #[error("{} is read by this very bake and would be replaced by its own result", path.display())]
    Input {
        /// The file.
        path: PathBuf,
    },
    /// The target is a device, pipe or socket.
    #[error("{} is no ordinary file", path.display())]
    NotAFile {
        /// Target that was refused.
        path: PathBuf,
    },
    /// A pattern for the names of maps that cannot be one.
    #[error("maps cannot be named '{pattern}': {why}")]
    Names {
        /// The pattern.
        pattern: String,
        /// Fault of the pattern and its remedy.
        why: String,
    },
    /// Two maps of a bake would have the same file.
    #[error(
        "two maps would be written to {file_name}; rename the material or the output that one of them belongs to, or \
         name maps with $material and $preset"
    )]
    SameName {
        /// The file, without its folder.
        file_name: String,
    },
    /// Two maps of a bake would have files whose names differ by capital letters alone.
    #[error(
        "two maps would be written to {first} and {second}, which are one file on systems that ignore capital letters; rename the \
         material or the output that one of them belongs to, or name maps with $material and $preset"
    )]
    SameLetters {
        /// A file, without its folder.
        first: String,
        /// The other one.
        second: String,
    },
    /// Two presets of a bake would write the same document.
    #[error(
        "two presets would write the document {file_name}; bake them one after the other, into folders of their own, or leave \
         `documents` out of one of them"
    )]
    SameDocument {
        /// The file, without its folder.
        file_name: String,
    },
    /// The model cannot be read again for its copy.
    #[error("no copy of {} can be made: {reason}", path.display())]
    Model {
        /// The model's file.
        path: PathBuf,
        /// Reason as a clause.
        reason: String,
    },
    /// The copy of the model does not fit into a GLB file.
    #[error(
        "the copy of {} would have {bytes} bytes, and a .glb file cannot have more than {}", path.display(), u32::MAX
    )]
    CopyTooLarge {
        /// The model's file.
        path: PathBuf,
        /// Bytes of its copy.
        bytes: u64,
    },
    /// The number of values does not fit the texture set.
    #[error("channel {channel} has {given} values for a texture set of {expected}; this is a defect of Sabi")]
    WrongSize {
        /// Name of the channel.
        channel: String,
        /// Values given.
        given: usize,
        /// Values that were expected.
        expected: usize,
    },
    /// The encoder refused.
    #[error("{file_name}: {source}")]
    Encode {
        /// The file, without its folder.
        file_name: String,
        /// Error of the encoder.
        source: ImageError,
    },
}

impl From<FileError> for ExportError {
    fn from(error: FileError) -> ExportError {
        let FileError {
            operation,
            path,
            source,
        } = error;
        match operation {
            Operation::CreateFolder => ExportError::CreateFolder { path, source },
            Operation::List
            | Operation::Write
            | Operation::Append
            | Operation::Replace
            | Operation::SyncFolder
            | Operation::Lock => ExportError::Write { path, source },
        }
    }
}

impl From<StagedError> for ExportError {
    fn from(error: StagedError) -> ExportError {
        match error {
            StagedError::File(error) => error.into(),
            StagedError::Protected { path } => ExportError::Input { path },
            StagedError::NotAFile { path } => ExportError::NotAFile { path },
            StagedError::SameName { file_name } => ExportError::SameName {
                file_name: Path::new(&file_name).display().to_string(),
            },
            StagedError::Commit { error, replaced, total } => ExportError::Replace {
                path: error.path,
                source: error.source,
                replaced,
                total,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_says_what_and_why() {
        let full = ExportError::Write {
            path: "out/a.png".into(),
            source: io::ErrorKind::StorageFull.into(),
        };
        assert_eq!(
            full.to_string(),
            "cannot write out/a.png, so nothing was changed: the disk is full"
        );
        let folder = ExportError::CreateFolder {
            path: "a/b".into(),
            source: io::ErrorKind::ReadOnlyFilesystem.into(),
        };
        assert_eq!(
            folder.to_string(),
            "cannot create the folder a/b: the disk is read-only"
        );
        let same = ExportError::SameName {
            file_name: "a.png".into(),
        };
        assert_eq!(
            same.to_string(),
            "two maps would be written to a.png; rename the material or the output that one of them belongs to, or \
             name maps with $material and $preset"
        );
        let letters = ExportError::SameLetters {
            first: "Wood_normal.png".into(),
            second: "wood_normal.png".into(),
        };
        assert_eq!(
            letters.to_string(),
            "two maps would be written to Wood_normal.png and wood_normal.png, which are one file on systems that ignore capital \
             letters; rename the material or the output that one of them belongs to, or name maps with $material and $preset"
        );
        let document = ExportError::SameDocument {
            file_name: "helmet.usda".into(),
        };
        assert_eq!(
            document.to_string(),
            "two presets would write the document helmet.usda; bake them one after the other, into folders of their own, or \
             leave `documents` out of one of them"
        );
        let large = ExportError::CopyTooLarge {
            path: "a.glb".into(),
            bytes: 1 << 32,
        };
        assert_eq!(
            large.to_string(),
            "the copy of a.glb would have 4294967296 bytes, and a .glb file cannot have more than 4294967295"
        );
    }
}
