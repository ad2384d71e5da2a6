//! Disk cache of ray results: rays take long to trace, and models seldom change.

use std::path::Path;

use sabi_files::{Cache, CacheKind};

/// Cache of ray results, four or more bytes per texel. The version changes whenever rays start or are cast differently,
/// since keys contain nodes, kernels and adapters, but not the code between them.
const KIND: CacheKind = CacheKind {
    prefix: "rays",
    version: 2,
    limit_bytes: 2 << 30,
};

/// Cache of ray results.
pub(crate) struct RayCache {
    cache: Option<Cache>,
}

impl RayCache {
    /// Creates the cache in a cache folder; nothing is stored without one.
    pub(crate) fn new(cache_dir: Option<&Path>) -> RayCache {
        RayCache {
            cache: cache_dir.map(|folder| Cache::new(folder.join("rays"), KIND)),
        }
    }

    pub(crate) fn is_open(&self) -> bool {
        self.cache.is_some()
    }

    /// Returns the results stored under a key.
    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.cache.as_ref()?.read(key)
    }

    /// Stores results. Returns a warning if that fails.
    pub(crate) fn keep(&self, key: &[u8; 32], results: &[u8]) -> Option<String> {
        let cache = self.cache.as_ref()?;
        let error = cache.write(key, results).err()?;
        Some(format!(
            "results of rays could not be stored in {} ({}), so they will be computed again; free some space there or \
             choose another cache folder",
            cache.folder().display(),
            error.reason()
        ))
    }
}
