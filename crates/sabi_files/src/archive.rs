//! Archives (zip): the same files always give the same bytes, and nothing that an archive claims is trusted when it is unpacked.

mod error;
mod names;
#[cfg(test)]
mod tests;
mod unpack;
pub(crate) mod write;

pub use error::ArchiveError;
pub use names::{EntryNames, NameFault};
pub use unpack::{Accepts, UnpackedArchive};
pub use write::{EntryContent, write_archive};

/// Maximum number of entries in an archive. A graph refers to some hundred files at most, so an archive with more entries
/// is not a packed graph, and each entry costs memory before its content is read.
pub const MOST_ENTRIES: usize = 10_000;

/// Maximum total size of the unpacked entries of an archive, in bytes. A small archive can unpack to a thousand times its
/// size and fill a disk. A model and the images of a graph, each of which may have 1 GiB, stay far below this limit.
pub const MOST_BYTES: u64 = 32 << 30;
