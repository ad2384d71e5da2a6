//! Decoding of text files from old and new programs.

use sabi_cancel::CancelableIterator as _;
use std::borrow::Cow;

/// Decodes UTF-8, or UTF-16 with a byte order mark, or otherwise Latin-1, which old programs write, so that different names
/// stay different.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].as_chunks().0.iter().map(|unit| from(*unit)).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, text @ ..] => String::from_utf8_lossy(text),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(bytes.iter().looking().map(|byte| char::from(*byte)).collect()),
        },
    }
}

/// Returns the bytes of a file without a byte order mark. Text in UTF-16 with such a mark is converted to UTF-8.
pub(super) fn unmarked(bytes: &[u8]) -> Cow<'_, [u8]> {
    match bytes {
        [0xef, 0xbb, 0xbf, text @ ..] => Cow::Borrowed(text),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Cow::Owned(decoded(bytes).into_owned().into_bytes()),
        _ => Cow::Borrowed(bytes),
    }
}

/// Returns the lines of a text, with the line ends of any system.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    let lines = std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = rest.bytes().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, after) = rest.split_at(end.unwrap_or(rest.len()));
        rest = after
            .strip_prefix("\r\n")
            .or_else(|| after.strip_prefix(['\n', '\r']))
            .unwrap_or(after);
        Some(line)
    });
    lines.looking()
}

/// Returns the bytes of a text, with line ends that are a single carriage return replaced by line feeds.
pub(super) fn with_line_feeds(text: &[u8]) -> Cow<'_, [u8]> {
    let is_lone = |at: usize| text[at] == b'\r' && text.get(at + 1) != Some(&b'\n');
    if !(0..text.len()).any(is_lone) {
        return Cow::Borrowed(text);
    }
    let byte = |at: usize| if is_lone(at) { b'\n' } else { text[at] };
    Cow::Owned((0..text.len()).map(byte).collect())
}

/// Maximum number of bytes of the name of a part. It is limited since many nodes may share the name of one mesh.
const MOST_NAME_BYTES: usize = 256;

/// Returns the name of a part, shortened if it is too long.
pub(super) fn part_name(name: &str) -> String {
    name[..name.floor_char_boundary(MOST_NAME_BYTES)].to_owned()
}
