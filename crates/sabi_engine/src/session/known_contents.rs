//! Contents of a session's file that a save may replace without a question, known by their hashes.

use blake3::Hash;

/// Hashes of contents of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownContents {
    /// Read or written by this session.
    own: Vec<Hash>,
    /// Seen, and not taken: written by another program.
    accepted: Option<Hash>,
}

impl KnownContents {
    /// Contents that were read from the file, or written to it.
    pub(super) fn of(own: &[&[u8]]) -> KnownContents {
        KnownContents {
            own: own.iter().map(|bytes| blake3::hash(bytes)).collect(),
            accepted: None,
        }
    }

    /// Contents of which only a stored hash is left.
    pub(super) fn of_stored(hash: &str) -> KnownContents {
        KnownContents {
            // A damaged hash is that of no content.
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

    /// Adds a content that another program has written and that may be replaced.
    pub(super) fn accept(&mut self, bytes: &[u8]) {
        self.accepted = Some(blake3::hash(bytes));
    }

    /// Returns whether this content was read or written by this session.
    pub(super) fn is_own(&self, bytes: &[u8]) -> bool {
        self.own.contains(&blake3::hash(bytes))
    }

    /// Returns whether this content may be replaced.
    pub(super) fn contains(&self, bytes: &[u8]) -> bool {
        self.is_own(bytes) || self.accepted == Some(blake3::hash(bytes))
    }

    /// Hash to store of the content that was read or written last.
    pub(super) fn stored(&self) -> Option<String> {
        self.own.last().map(|hash| hash.to_hex().to_string())
    }
}
