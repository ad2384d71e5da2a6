//! Contents of a session's file that a save may replace without asking, identified by their hashes.

use blake3::Hash;

/// Hashes of contents of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownContents {
    /// Contents that this session read or wrote.
    own: Vec<Hash>,
    /// Content written by another program that may be replaced although it was not read.
    accepted: Option<Hash>,
}

impl KnownContents {
    /// Creates the set from contents that were read from the file or written to it.
    pub(super) fn of(own: &[&[u8]]) -> KnownContents {
        KnownContents {
            own: own.iter().map(|bytes| blake3::hash(bytes)).collect(),
            accepted: None,
        }
    }

    /// Creates the set from the stored hash of a content.
    pub(super) fn of_stored(hash: &str) -> KnownContents {
        KnownContents {
            // A damaged hash matches no content.
            own: Hash::from_hex(hash).into_iter().collect(),
            accepted: None,
        }
    }

    /// Adds a content that this session writes.
    pub(super) fn add(&mut self, bytes: &[u8]) {
        let hash = blake3::hash(bytes);
        if !self.own.contains(&hash) {
            self.own.push(hash);
        }
    }

    /// Adds a content of another program that may be replaced.
    pub(super) fn accept(&mut self, bytes: &[u8]) {
        self.accepted = Some(blake3::hash(bytes));
    }

    /// Returns true if this session read or wrote this content.
    pub(super) fn is_own(&self, bytes: &[u8]) -> bool {
        self.own.contains(&blake3::hash(bytes))
    }

    /// Returns true if this content may be replaced.
    pub(super) fn contains(&self, bytes: &[u8]) -> bool {
        self.is_own(bytes) || self.accepted == Some(blake3::hash(bytes))
    }

    /// Returns the hash to store: that of the content that was read or written last.
    pub(super) fn stored(&self) -> Option<String> {
        self.own.last().map(|hash| hash.to_hex().to_string())
    }
}
