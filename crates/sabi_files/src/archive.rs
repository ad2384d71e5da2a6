//! Archives (zip): written whole and alike for like files, and unpacked without trust in what they claim.

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

/// Most entries of an archive. A graph names some hundred files at most; an archive with more is no packed graph, and each entry costs
/// memory before its content is looked at.
pub const MOST_ENTRIES: usize = 10_000;

/// Most bytes that the entries of an archive have together when unpacked. A small archive can unpack to a thousand times its size and
/// fill a disk; a model and the pictures of a graph, each of which may have 1 GiB, stay far below.
pub const MOST_BYTES: u64 = 32 << 30;
