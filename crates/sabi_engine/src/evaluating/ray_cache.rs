//! Results of rays on disk: they take long to shoot, and models seldom change.

use std::path::{Path, PathBuf};

use sabi_surface::disk::{self, Kind};

/// The number in the magic rises whenever rays start or are followed differently: keys name nodes, kernels and adapters, not
/// what the program does between them. Results take four bytes a texel and more.
const KIND: Kind = Kind {
    magic: b"sabi rays 2\n",
    prefix: "rays",
    limit_bytes: 2 << 30,
};

/// The folder of kept results.
pub(crate) struct RayCache {
    folder: Option<PathBuf>,
}

impl RayCache {
    /// In a cache folder; nothing is kept without one.
    pub(crate) fn new(cache_dir: Option<&Path>) -> RayCache {
        RayCache {
            folder: cache_dir.map(|folder| folder.join("rays")),
        }
    }

    pub(crate) fn is_open(&self) -> bool {
        self.folder.is_some()
    }

    /// What was kept under a key, if it is whole.
    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        disk::read(self.folder.as_ref()?, &KIND, key)
    }

    /// Keeps results; a sentence where that cannot be.
    pub(crate) fn keep(&self, key: &[u8; 32], results: &[u8]) -> Option<String> {
        let folder = self.folder.as_ref()?;
        let error = disk::keep(folder, &KIND, key, results).err()?;
        Some(format!(
            "what rays found could not be kept in {} ({error}), so they will be shot again; free some space there or \
             choose another cache folder",
            folder.display()
        ))
    }
}
