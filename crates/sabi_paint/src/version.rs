//! Names of lists of strokes.

use std::fmt;
use std::str::FromStr;

/// Name of a list of strokes: a hash of the step that leads to it and of the version before. 16 hexadecimal digits as text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Version(pub [u8; 8]);

impl Version {
    /// The empty list.
    pub const EMPTY: Version = Version([0; 8]);

    /// The version that a step leads to from this one; `step` is the step as a file holds it.
    pub fn after(self, step: &[u8]) -> Version {
        let mut hash = blake3::Hasher::new();
        hash.update(b"sabi paint step");
        hash.update(&self.0);
        hash.update(step);
        let mut version = [0; 8];
        version.copy_from_slice(&hash.finalize().as_bytes()[..8]);
        Version(version)
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// A text is no version.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a version of strokes has 16 hexadecimal digits")]
pub struct NoVersion;

impl FromStr for Version {
    type Err = NoVersion;

    fn from_str(text: &str) -> Result<Version, NoVersion> {
        if text.len() != 16 || !text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(NoVersion);
        }
        u64::from_str_radix(text, 16)
            .map(|number| Version(number.to_be_bytes()))
            .map_err(|_| NoVersion)
    }
}
