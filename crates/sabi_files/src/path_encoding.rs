//! Paths stored as text that can be converted back exactly, Unicode or not.
//!
//! A Unicode path is stored unchanged. Any other path is stored as a NUL character, which no path contains, followed by the
//! hexadecimal digits of its bytes (on Windows, of its 16-bit units).

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// First character of the stored form of a path that is not Unicode.
const NOT_UNICODE: char = '\0';

/// Returns a path as text from which [`path_from_stored`] gives exactly the same path.
pub fn stored_path(path: &Path) -> String {
    match path.to_str() {
        Some(text) => text.to_owned(),
        None => {
            let digits = units_of(path).into_iter().map(|unit| format!("{unit:04x}"));
            std::iter::once(NOT_UNICODE.to_string()).chain(digits).collect()
        }
    }
}

/// Returns the path of a text that [`stored_path`] returned; `None` if the text is damaged.
pub fn path_from_stored(text: &str) -> Option<PathBuf> {
    let Some(digits) = text.strip_prefix(NOT_UNICODE) else {
        return Some(PathBuf::from(text));
    };
    let (units, rest) = digits.as_bytes().as_chunks::<4>();
    let units = units.iter().map(|unit| {
        let unit = std::str::from_utf8(unit).ok()?;
        u16::from_str_radix(unit, 16).ok()
    });
    let units: Option<Vec<u16>> = units.collect();
    units
        .filter(|_| rest.is_empty())
        .and_then(path_of_units)
        .map(PathBuf::from)
}

#[cfg(unix)]
fn units_of(path: &Path) -> Vec<u16> {
    use std::os::unix::ffi::OsStrExt;
    path.as_os_str()
        .as_bytes()
        .iter()
        .map(|byte| u16::from(*byte))
        .collect()
}

#[cfg(unix)]
fn path_of_units(units: Vec<u16>) -> Option<OsString> {
    use std::os::unix::ffi::OsStringExt;
    let bytes: Result<Vec<u8>, _> = units.into_iter().map(u8::try_from).collect();
    bytes.ok().map(OsString::from_vec)
}

#[cfg(windows)]
fn units_of(path: &Path) -> Vec<u16> {
    use std::os::windows::ffi::OsStrExt;
    path.as_os_str().encode_wide().collect()
}

#[cfg(windows)]
fn path_of_units(units: Vec<u16>) -> Option<OsString> {
    use std::os::windows::ffi::OsStringExt;
    Some(OsString::from_wide(&units))
}

/// Serialization of a list of paths in their stored form, for `#[serde(with = "…")]`.
pub mod list {
    use std::path::PathBuf;

    use serde::{Deserialize, Deserializer, Serializer};

    use super::{path_from_stored, stored_path};

    /// Serializes a list of paths.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(paths: &[PathBuf], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(paths.iter().map(|path| stored_path(path)))
    }

    /// Deserializes a list of paths.
    ///
    /// # Errors
    /// The data is not a list of texts, or one of the texts is damaged.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<PathBuf>, D::Error> {
        let texts = Vec::<String>::deserialize(from)?;
        texts.iter().map(|text| super::read(path_from_stored(text))).collect()
    }
}

/// Serialization of a map whose keys are paths in their stored form, for `#[serde(with = "…")]`.
pub mod map {
    use std::collections::BTreeMap;
    use std::path::PathBuf;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{path_from_stored, stored_path};

    /// Serializes a map whose keys are paths.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer, V: Serialize>(map: &BTreeMap<PathBuf, V>, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(map.iter().map(|(path, value)| (stored_path(path), value)))
    }

    /// Deserializes a map whose keys are paths.
    ///
    /// # Errors
    /// The data is not such a map, or one of its keys is damaged.
    pub fn deserialize<'de, D: Deserializer<'de>, V: Deserialize<'de>>(
        from: D,
    ) -> Result<BTreeMap<PathBuf, V>, D::Error> {
        let texts = BTreeMap::<String, V>::deserialize(from)?;
        let entries = texts.into_iter();
        entries
            .map(|(text, value)| Ok((super::read(path_from_stored(&text))?, value)))
            .collect()
    }
}

/// Serialization of a path that may be absent, in its stored form, for `#[serde(with = "…")]`.
pub mod optional {
    use std::path::PathBuf;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{path_from_stored, stored_path};

    /// Serializes a path that may be absent.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(path: &Option<PathBuf>, to: S) -> Result<S::Ok, S::Error> {
        path.as_ref().map(|path| stored_path(path)).serialize(to)
    }

    /// Deserializes a path that may be absent.
    ///
    /// # Errors
    /// The data is not a text, or the text is damaged.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<PathBuf>, D::Error> {
        let text = Option::<String>::deserialize(from)?;
        text.map(|text| super::read(path_from_stored(&text))).transpose()
    }
}

fn read<E: serde::de::Error>(path: Option<PathBuf>) -> Result<PathBuf, E> {
    path.ok_or_else(|| E::custom("a stored path is damaged"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stored_path_is_restored_exactly() {
        for text in ["", "a.sabi", "/w/ä/a b.sabi", "C:\\x", "0000"] {
            assert_eq!(stored_path(Path::new(text)), text);
            assert_eq!(path_from_stored(text).unwrap(), Path::new(text));
        }
        for damaged in ["\x000", "\x00zzzz", "\x000061f"] {
            assert_eq!(path_from_stored(damaged), None);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_path_that_is_not_utf_8_is_restored_exactly() {
        use std::os::unix::ffi::OsStrExt;
        let path = Path::new(std::ffi::OsStr::from_bytes(b"/w/\xff\xc3.sabi"));
        let stored = stored_path(path);
        assert_eq!(path_from_stored(&stored).unwrap(), path);
        assert_ne!(stored, stored_path(Path::new("/w/\u{fffd}\u{fffd}.sabi")));
        assert_eq!(path_from_stored("\x00ffff"), None, "no byte is that large");
    }
}
