//! Packing of a graph and everything needed to bake it elsewhere into one archive, and unpacking.

mod archive_check;
mod entries;
mod manifest;
pub(crate) mod model_files;
pub(crate) mod named_files;
mod named_inputs;
mod needs;
pub(crate) mod own_nodes;
mod pack;
mod places;
mod rewritten_paths;
mod unpack;

pub use named_inputs::{NamedInputs, inputs_of_graph, inputs_of_model};
pub use pack::{PackReport, PackRequest, PackedFile, PackedModel, pack_graph};
pub use unpack::{UnpackReport, unpack_graph};

use sabi_files::archive::ArchiveError;

use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

impl From<ArchiveError> for EngineError {
    fn from(error: ArchiveError) -> Self {
        let (kind, remedies): (ErrorKind, &[Remedy]) = match error {
            ArchiveError::Disk(error) => return error.into(),
            ArchiveError::Exists(_) => (ErrorKind::CannotWrite, &[Remedy::ReplaceFile]),
            ArchiveError::FolderInUse(_) | ArchiveError::NoFolder(_) => {
                (ErrorKind::CannotWrite, &[Remedy::OtherFolder])
            }
            ArchiveError::Unmade(_) => (ErrorKind::CannotWrite, &[]),
            ArchiveError::Unread { .. } => (ErrorKind::MissingInput, &[]),
            ArchiveError::Changed(_) => (ErrorKind::BadInput, &[Remedy::TryAgain]),
            ArchiveError::Canceled => (ErrorKind::Interrupted, &[]),
            ArchiveError::Name { .. }
            | ArchiveError::TooMany(_)
            | ArchiveError::TooLarge(_)
            | ArchiveError::NoArchive { .. }
            | ArchiveError::SameNames
            | ArchiveError::NotPlain(_)
            | ArchiveError::Encrypted(_)
            | ArchiveError::Unwanted { .. }
            | ArchiveError::Overlapping(_)
            | ArchiveError::Damaged { .. } => (ErrorKind::BadInput, &[]),
        };
        EngineError::of(kind, error).with_remedies(remedies.iter().copied())
    }
}
