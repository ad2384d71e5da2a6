//! Text files of old and new programs.

use std::borrow::Cow;

/// Text in UTF-8, or in UTF-16 where it says so, or else in Latin-1, which old programs write: names stay distinct.
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
            Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        },
    }
}

/// Most bytes of the name of a part: many nodes may share that of one mesh.
const MOST_NAME_BYTES: usize = 256;

/// Returns a name of a part, or as much of it as is kept.
pub(super) fn part_name(name: &str) -> String {
    name[..name.floor_char_boundary(MOST_NAME_BYTES)].to_owned()
}
