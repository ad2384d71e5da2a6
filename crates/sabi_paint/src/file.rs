//! The stroke file: a text header, and steps one behind another.
//!
//! ```text
//! sabi paint 1
//! model: crate
//!
//! ```
//!
//! The empty line is followed by records: the marker `SPR1`, the length of the step in bytes (u32), the version before the step (8 bytes),
//! the step, and the version after the step (8 bytes). The latter is a hash of the step and the version before, so it shows whether the
//! record is complete. A step is the length of its description (u32), the description as JSON, and the points of a stroke. If the
//! description has `source`, the first point is the one from which the stroke copies. A point is the number of the triangle (u32), its key
//! (u32), position (3 × f32), normal (2 × i16, octahedral), and pressure in 15 bits with the flag of a new start above them (u16). If the
//! description has `shafts`, the shafts of the pen follow for all these points (2 × i16, octahedral; −32768 twice for an unknown shaft),
//! and a byte 0. All numbers are little-endian.

mod read;
#[cfg(test)]
mod tests;

use std::path::Path;

use sabi_files::{Disk, FileError};
use thiserror::Error;

use crate::list::StrokeBook;
use crate::version::Version;

pub use read::{ReadStrokes, read};

/// First line of a stroke file.
const TITLE: &str = "sabi paint 1";
/// Start of a record, by which the next complete record after a damaged one is found.
const MARKER: &[u8; 4] = b"SPR1";
/// Bytes of a record besides its step.
const FRAME_BYTES: usize = 4 + 4 + 8 + 8;
/// Maximum size of a file that is read.
pub const FILE_LIMIT_BYTES: u64 = 1 << 30;

/// Error of a stroke file that cannot be used at all.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StrokeFileError {
    /// The file is not a stroke file.
    #[error("it is not a file of strokes")]
    NoStrokes,
    /// The file is from a later version of the program.
    #[error("it was written by a newer version of Sabi")]
    Newer,
}

/// Error of strokes that cannot be stored.
#[derive(Debug, Error)]
pub enum StoreError {
    /// The version is not known, so nothing was written.
    #[error("the strokes of version {0} are not known")]
    Unknown(Version),
    /// Error of the disk.
    #[error(transparent)]
    Disk(#[from] FileError),
}

/// Header of the file for a model.
fn header(model: &str) -> String {
    let name: String = model.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("{TITLE}\nmodel: {name}\n\n")
}

/// Appends a record.
fn push_record(bytes: &mut Vec<u8>, before: Version, step: &[u8]) {
    bytes.extend_from_slice(MARKER);
    bytes.extend_from_slice(&(step.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&before.0);
    bytes.extend_from_slice(step);
    bytes.extend_from_slice(&before.after(step).0);
}

/// Returns a whole file with all known steps to some versions, without repeats.
pub fn whole(model: &str, book: &StrokeBook, versions: &[Version]) -> Vec<u8> {
    let mut bytes = header(model).into_bytes();
    let mut written = std::collections::BTreeSet::new();
    for version in versions {
        for (after, before, step) in book.way_to(*version) {
            if written.insert(after) {
                push_record(&mut bytes, before, step);
            }
        }
    }
    bytes
}

/// Stores all known steps to a version that a file does not have yet. `stored` are the versions that it has. The steps are
/// appended and synced; a new file is written as a whole.
///
/// # Errors
/// The version is not known, or the disk refuses; the file then holds what it held.
pub fn store(
    disk: &Disk,
    file: &Path,
    model: &str,
    book: &StrokeBook,
    version: Version,
    stored: &mut std::collections::BTreeSet<Version>,
) -> Result<(), StoreError> {
    let way = book.way_to(version);
    if way.is_empty() {
        return Err(StoreError::Unknown(version));
    }
    let mut bytes = Vec::new();
    let mut added = Vec::new();
    for (after, before, step) in way {
        if !stored.contains(&after) {
            push_record(&mut bytes, before, step);
            added.push(after);
        }
    }
    if added.is_empty() {
        return Ok(());
    }
    if stored.is_empty() {
        let mut whole = header(model).into_bytes();
        whole.append(&mut bytes);
        disk.write_whole(file, &whole)?;
    } else {
        disk.append_durably(file, &bytes)?;
    }
    stored.extend(added);
    Ok(())
}
