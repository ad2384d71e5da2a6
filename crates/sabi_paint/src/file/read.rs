//! Reads a stroke file.

use std::collections::BTreeSet;

use super::{FRAME_BYTES, MARKER, StrokeFileError, TITLE};
use crate::list::StrokeBook;
use crate::step_bytes::decode_step;
use crate::version::Version;

/// Content of a stroke file.
#[derive(Clone, Debug, Default)]
pub struct ReadStrokes {
    /// Name of the model that was painted on.
    pub model: String,
    /// Versions whose steps were read from the file.
    pub versions: BTreeSet<Version>,
    /// Version of the last complete record.
    pub last: Option<Version>,
    /// Number of bytes that belong to no complete record. If it is above 0, the file was truncated or damaged and must not be written to.
    pub damaged_bytes: usize,
}

/// Reads the bytes of a stroke file into a book.
///
/// # Errors
/// It is no stroke file, or one of a later version of the program.
pub fn read(bytes: &[u8], book: &mut StrokeBook) -> Result<ReadStrokes, StrokeFileError> {
    let end = find(bytes, b"\n\n").ok_or(StrokeFileError::NoStrokes)?;
    let text = std::str::from_utf8(&bytes[..end]).map_err(|_| StrokeFileError::NoStrokes)?;
    let mut lines = text.lines();
    match lines.next() {
        Some(TITLE) => {}
        Some(title) if title.starts_with("sabi paint ") => return Err(StrokeFileError::Newer),
        _ => return Err(StrokeFileError::NoStrokes),
    }
    let model = lines.find_map(|line| line.strip_prefix("model: "));
    let mut read = ReadStrokes {
        // Without the name of a model, the strokes belong to no model.
        model: model.unwrap_or_default().to_owned(),
        ..ReadStrokes::default()
    };
    let mut rest = &bytes[end + 2..];
    // Number of bytes of records that turned out to be incomplete. It is limited, so that reading a forged file ends.
    let mut in_vain = 0;
    while !rest.is_empty() {
        let found = if in_vain > IN_VAIN_LIMIT {
            None
        } else {
            record(rest, &mut in_vain)
        };
        match found {
            Some((before, step, after, size)) => {
                // A step of an unknown kind keeps its bytes in the file, but leads to no version.
                match decode_step(step, after) {
                    Some(decoded) => {
                        book.insert(after, before, decoded, step.into());
                        read.versions.insert(after);
                        read.last = Some(after);
                    }
                    None => read.damaged_bytes += size,
                }
                rest = &rest[size..];
            }
            None => {
                let skipped = find(&rest[1..], MARKER).map_or(rest.len(), |at| at + 1);
                read.damaged_bytes += skipped;
                rest = &rest[skipped..];
            }
        }
    }
    Ok(read)
}

/// Maximum number of bytes of incomplete records, after which the rest of a file counts as damaged.
const IN_VAIN_LIMIT: usize = 1 << 30;

/// Returns the record at the start of some bytes: version before, step, version after, and size. `None` if it is not
/// complete; in this case its bytes are added to `in_vain`.
fn record<'b>(bytes: &'b [u8], in_vain: &mut usize) -> Option<(Version, &'b [u8], Version, usize)> {
    let rest = bytes.strip_prefix(MARKER)?;
    let (length, rest) = rest.split_first_chunk::<4>()?;
    let length = u32::from_le_bytes(*length) as usize;
    let (before, rest) = rest.split_first_chunk::<8>()?;
    let (step, rest) = rest.split_at_checked(length)?;
    let after = Version(*rest.first_chunk::<8>()?);
    let before = Version(*before);
    if before.after(step) != after {
        *in_vain += step.len();
        return None;
    }
    Some((before, step, after, FRAME_BYTES + length))
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}
