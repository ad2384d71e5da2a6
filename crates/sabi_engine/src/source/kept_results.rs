//! Results of nodes on disk, for later bakes: those that take long to compute.

use std::path::Path;

use sabi_files::{Cache, CacheKey, CacheKind};

use crate::program::Build;

/// Version of the stored bytes.
const VERSION: u32 = 1;

/// Results of nodes on disk. Those of other programs are not found, since they may be computed otherwise.
pub(crate) struct KeptResults {
    cache: Cache,
    build: &'static str,
}

impl KeptResults {
    /// Opens the results in a cache folder, with a limit of their size; `None` where the program is not known.
    pub(crate) fn open(cache_dir: &Path, limit_bytes: u64) -> Option<KeptResults> {
        let kind = CacheKind {
            prefix: "result",
            version: VERSION,
            limit_bytes,
        };
        Some(KeptResults {
            cache: Cache::new(cache_dir.join("results"), kind),
            build: Build::current().blake3.as_deref()?,
        })
    }

    pub(crate) fn contains(&self, key: &[u8; 32]) -> bool {
        self.cache.contains(&self.key(key))
    }

    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.cache.read(&self.key(key))
    }

    pub(crate) fn keep(&self, key: &[u8; 32], result: &[u8]) {
        if let Err(error) = self.cache.write(&self.key(key), result) {
            // The next bake computes it again.
            tracing::warn!("a result is not kept: {error}");
        }
    }

    fn key(&self, result: &[u8; 32]) -> CacheKey {
        let mut hash = blake3::Hasher::new_derive_key("sabi results of nodes");
        hash.update(self.build.as_bytes());
        hash.update(result);
        *hash.finalize().as_bytes()
    }
}
