//! Files that the bake of an item reads, and their hashes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_engine::program::digest;
use sabi_engine::{EngineError, ErrorKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// File that a bake reads.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct ItemInput {
    /// Name that does not depend on the location of the project: the path from the folder of the graph, or below `mesh/`
    /// from the folder of the model.
    pub name: String,
    /// Path.
    pub path: String,
    /// BLAKE3 of the bytes, hexadecimal.
    pub blake3: String,
}

impl ItemInput {
    /// Returns the fields that identify the content, independent of the location of the file.
    pub(crate) fn identity(&self) -> [&str; 2] {
        [&self.name, &self.blake3]
    }
}

/// Hashes of files, each read once.
#[derive(Debug, Default)]
pub struct InputHashes(BTreeMap<PathBuf, String>);

impl InputHashes {
    /// Returns the hash of a file, hexadecimal.
    ///
    /// # Errors
    /// A sentence: the file cannot be read.
    pub(crate) fn of(&mut self, path: &Path) -> Result<String, EngineError> {
        if let Some(known) = self.0.get(path) {
            return Ok(known.clone());
        }
        let Some((_, hash)) = digest(path) else {
            let why = match path.exists() {
                true => "the file cannot be read",
                false => "there is no such file; check the path",
            };
            return Err(EngineError::new(
                ErrorKind::MissingInput,
                format!("{}: {why}", path.display()),
            ));
        };
        self.0.insert(path.to_owned(), hash.clone());
        Ok(hash)
    }
}
