//! Disk cache of ray results: rays take long to trace, and models seldom change.

use std::path::{Path, PathBuf};

use sabi_surface::disk::{self, Kind};

/// The version in the magic rises whenever rays are generated or traced differently: keys name nodes, kernels and adapters, but
/// not the code between them. A result takes four bytes per texel or more.
const KIND: Kind = Kind {
    magic: b"sabi rays 2\n",
    prefix: "rays",
    limit_bytes: 2 << 30,
};

/// Disk cache of ray results.
pub(crate) struct RayCache {
    folder: Option<PathBuf>,
}

impl RayCache {
    /// Creates the cache in a cache folder; without one nothing is cached.
    pub(crate) fn new(cache_dir: Option<&Path>) -> RayCache {
        RayCache {
            folder: cache_dir.map(|folder| folder.join("rays")),
        }
    }

    pub(crate) fn is_open(&self) -> bool {
        self.folder.is_some()
    }

    /// Reads the result of a key, if it is cached and intact.
    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        disk::read(self.folder.as_ref()?, &KIND, key)
    }

    /// Caches results; returns a warning where that fails.
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
