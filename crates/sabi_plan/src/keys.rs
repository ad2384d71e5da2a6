//! Keys: hashes of everything that can change a result. They are used instead of dirty flags.

use sabi_nodes::kind::Kind;

use crate::request::Planner;
use crate::resolved_graph::{Behavior, ResolvedGraph, ResolvedNode};

impl Planner<'_> {
    /// Key of a node's results: source text with its libraries, values, keys of the inputs, surface.
    pub(crate) fn node_key(&self, index: usize, ready: &ResolvedNode<'_>, resolved: &ResolvedGraph<'_>) -> [u8; 32] {
        let mut hash = blake3::Hasher::new();
        hash.update(&self.surface_key);
        let node = &self.graph.nodes[index];
        part(&mut hash, node.kind.as_bytes());
        if let Behavior::Shader(kind) = ready.behavior {
            self.hash_text(&mut hash, kind);
        }
        let mut part = |bytes: &[u8]| part(&mut hash, bytes);
        match ready.behavior {
            Behavior::Shader(_) => {}
            Behavior::Source(kind) | Behavior::Sink(kind) => {
                part(&kind.content);
                part(&ready.source_values.key_bytes());
                if let Some(Ok(content)) = self.files.get(&index) {
                    part(content);
                }
            }
        }
        part(&ready.params);
        part(&[u8::from(ready.is_by_piece)]);
        for (index, input) in ready.inputs.iter().enumerate() {
            match input {
                Some(input) => {
                    part(&[1]);
                    part(&(input.output as u64).to_le_bytes());
                    part(&resolved.nodes[input.node].as_ref().map_or([0; 32], |from| from.key));
                }
                None => {
                    part(&[0]);
                    for number in ready.knobs.get(index).into_iter().flatten().flatten() {
                        part(&number.to_le_bytes());
                    }
                }
            }
        }
        for param in &ready.masked_params {
            part(&(*param as u64).to_le_bytes());
        }
        *hash.finalize().as_bytes()
    }

    /// Adds the text of a kind and of its libraries.
    pub(crate) fn hash_text(&self, hash: &mut blake3::Hasher, kind: &Kind) {
        part(hash, kind.source.as_bytes());
        for name in std::iter::once("core").chain(kind.libraries.iter().map(String::as_str)) {
            // The default is never used: a kind is refused if a library that it uses is missing.
            part(hash, self.library.libraries().text(name).unwrap_or_default().as_bytes());
        }
    }
}

/// Adds bytes with their length, so that different divisions into parts give different hashes.
fn part(hash: &mut blake3::Hasher, bytes: &[u8]) {
    hash.update(&(bytes.len() as u64).to_le_bytes());
    hash.update(bytes);
}

/// Key of one result of a node.
pub(crate) fn result_key(node: &ResolvedNode<'_>, output: &str) -> [u8; 32] {
    let mut hash = blake3::Hasher::new();
    hash.update(&node.key);
    hash.update(output.as_bytes());
    *hash.finalize().as_bytes()
}
