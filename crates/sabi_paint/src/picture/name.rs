//! Names of pictures that brushes stamp.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Maximum length of the extension of a picture's file.
const ENDING_LIMIT: usize = 8;

/// Name of a picture: a hash of its file and the extension of the file, for example `0123456789abcdef.png`. It is a plain file name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct PictureName(String);

/// Error of a text that is not the name of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a picture of a brush has 16 hexadecimal digits, a dot and the ending of its file")]
pub struct NoPictureName;

impl PictureName {
    /// Returns the name of a picture with these bytes. `ending` is the extension of its file without the dot. `None` if it
    /// has characters that are not allowed.
    pub fn of(bytes: &[u8], ending: &str) -> Option<PictureName> {
        let hash = blake3::hash(bytes);
        let digits: String = hash.as_bytes()[..8].iter().map(|byte| format!("{byte:02x}")).collect();
        PictureName::try_from(format!("{digits}.{}", ending.to_ascii_lowercase())).ok()
    }

    /// The name as a text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns true if the picture has these bytes.
    pub fn is_of(&self, bytes: &[u8]) -> bool {
        let ending = self.0.split_once('.').map_or("", |(_, ending)| ending); // Every name has an extension.
        PictureName::of(bytes, ending).as_ref() == Some(self)
    }
}

impl fmt::Display for PictureName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<PictureName> for String {
    fn from(name: PictureName) -> String {
        name.0
    }
}

impl TryFrom<String> for PictureName {
    type Error = NoPictureName;

    fn try_from(text: String) -> Result<PictureName, NoPictureName> {
        let (digits, ending) = text.split_once('.').ok_or(NoPictureName)?;
        let is_hash = digits.len() == 16 && digits.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
        let is_ending = (1..=ENDING_LIMIT).contains(&ending.len())
            && ending
                .bytes()
                .all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit());
        if is_hash && is_ending {
            Ok(PictureName(text))
        } else {
            Err(NoPictureName)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_plain_file_name_of_its_content() {
        let name = PictureName::of(b"pixels", "PNG").expect("a name");
        assert!(name.is_of(b"pixels") && !name.is_of(b"other"));
        assert!(name.as_str().ends_with(".png"));
        for odd in [
            "",
            "0123456789abcdef",
            "../0123456789a.png",
            "0123456789abcdef.p/g",
            "0123456789ABCDEF.png",
        ] {
            assert_eq!(PictureName::try_from(odd.to_owned()), Err(NoPictureName), "{odd}");
        }
        assert_eq!(PictureName::of(b"pixels", "../x"), None);
    }
}
