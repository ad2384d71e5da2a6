//! Ids and seeds of new nodes.

use std::collections::BTreeSet;
use std::hash::{BuildHasher, RandomState};

use sabi_graph::{Graph, NodeId};

/// Letters for the random end of an id.
const LETTERS: &[u8] = b"abcdefghijklmnopqrstuvwxyz0123456789";
const TAIL: usize = 4;
/// Upper limit of random seeds, small enough to be read and typed easily.
const SEEDS: u64 = 10_000;

/// Generator of the random ends of ids, and of random seeds.
#[derive(Clone, Debug)]
pub(crate) struct IdGenerator {
    state: u64,
}

impl IdGenerator {
    /// Creates a generator with a random state, so that two people who add nodes to the same file get different ids.
    pub(crate) fn random() -> IdGenerator {
        IdGenerator {
            state: RandomState::new().hash_one(0),
        }
    }

    #[cfg(test)]
    pub(crate) fn seeded(state: u64) -> IdGenerator {
        IdGenerator { state }
    }

    /// Returns the next random number (SplitMix64, Steele, Lea and Flood 2014).
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A seed for a new node.
    pub(crate) fn seed(&mut self) -> u32 {
        (self.next() % SEEDS) as u32
    }

    /// Returns an id that is neither in the graph nor among `taken`: a readable stem with a random end.
    pub(crate) fn id(&mut self, stem: &str, graph: &Graph, taken: &BTreeSet<NodeId>) -> NodeId {
        let readable: String = stem
            .chars()
            .filter(|letter| letter.is_ascii_lowercase() || *letter == '_')
            .collect();
        let readable = readable.trim_matches('_');
        let stem = if readable.is_empty() {
            "node"
        } else {
            &readable[..readable.len().min(32)]
        };
        loop {
            let mut random = self.next();
            let tail = (0..TAIL).map(|_| {
                let letter = LETTERS[(random % LETTERS.len() as u64) as usize];
                random /= LETTERS.len() as u64;
                char::from(letter)
            });
            let id = format!("{stem}_{}", tail.collect::<String>()).parse::<NodeId>();
            // Lower-case letters, digits and underscores always form a valid id.
            if let Ok(id) = id
                && graph.node(id.as_str()).is_none()
                && !taken.contains(&id)
            {
                return id;
            }
        }
    }
}
