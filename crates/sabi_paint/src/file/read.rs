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
    /// Versions whose steps were read, of which the file holds a record.
    pub versions: BTreeSet<Version>,
    /// Version of the last whole record.
    pub last: Option<Version>,
    /// Bytes that belong to no whole record: the file was cut off or damaged. It must not be written to then.
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
        // A header without the model leaves strokes that no model finds.
        model: model.unwrap_or_default().to_owned(),
        ..ReadStrokes::default()
    };
    let mut rest = &bytes[end + 2..];
    // Bytes of records that turned out not to be whole: a file of forged ones is not read for ever.
    let mut in_vain = 0;
    while !rest.is_empty() {
        let found = if in_vain > IN_VAIN_LIMIT {
            None
        } else {
            record(rest, &mut in_vain)
        };
        match found {
            Some((before, step, after, size)) => {
                // A step of a kind that this version does not know keeps its bytes in the file, but leads nowhere.
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

/// Most bytes of records that turn out not to be whole, before the rest of a file counts as damaged.
const IN_VAIN_LIMIT: usize = 1 << 30;

/// The record at the start of bytes: version before, step, version after, and its size; none if it is not whole, whose bytes are added
/// to `in_vain`.
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
