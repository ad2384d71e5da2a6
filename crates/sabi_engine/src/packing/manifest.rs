//! The entry of an archive that says which of its files is the graph.

use serde::{Deserialize, Serialize};

/// Name of the entry.
pub(super) const NAME: &str = "pack.json";
/// Largest manifest that is read.
pub(super) const LIMIT_BYTES: u64 = 1 << 16;
const FORMAT: &str = "sabi-pack";
const VERSION: u32 = 1;

/// Graph and model of an archive, as names of entries.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ArchiveManifest {
    format: String,
    version: u32,
    pub(super) graph: String,
    pub(super) model: Option<String>,
}

impl ArchiveManifest {
    pub(super) fn new(graph: String, model: Option<String>) -> ArchiveManifest {
        ArchiveManifest {
            format: FORMAT.to_owned(),
            version: VERSION,
            graph,
            model,
        }
    }

    pub(super) fn bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut bytes = serde_json::to_vec_pretty(self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// Reads a manifest; the error is a clause.
    pub(super) fn read(bytes: &[u8]) -> Result<ArchiveManifest, String> {
        let read: Result<ArchiveManifest, _> = serde_json::from_slice(bytes);
        let manifest = read.map_err(|error| format!("its {NAME} is damaged: {error}"))?;
        if manifest.format != FORMAT {
            return Err(format!("its {NAME} is of another program"));
        }
        if manifest.version > VERSION {
            return Err("it was packed by a newer version of Sabi".to_owned());
        }
        Ok(manifest)
    }
}
