//! Cache on disk that only the program which made the results reads, since another program may make them differently.

use std::path::Path;

use sabi_files::{Cache, CacheKey, CacheKind, Disk};

use crate::program::Build;

/// Version of the stored bytes.
const VERSION: u32 = 1;

/// Results of this program on disk. A result that cannot be stored is made again the next time.
#[derive(Debug)]
pub(crate) struct ProgramCache {
    cache: Cache,
    build: &'static str,
}

impl ProgramCache {
    /// Opens the results of a kind in a folder of the cache folder, with a size limit; `None` if the program cannot be identified.
    pub(crate) fn open(cache_dir: &Path, folder: &str, prefix: &'static str, limit_bytes: u64) -> Option<ProgramCache> {
        let kind = CacheKind {
            prefix,
            version: VERSION,
            limit_bytes,
        };
        Some(ProgramCache {
            cache: Cache::new(cache_dir.join(folder), kind),
            build: Build::current().blake3.as_deref()?,
        })
    }

    /// Makes it write to this disk from now on.
    pub(crate) fn on_disk(self, disk: &Disk) -> ProgramCache {
        ProgramCache {
            cache: self.cache.on_disk(disk),
            ..self
        }
    }

    pub(crate) fn contains(&self, key: &[u8; 32]) -> bool {
        self.cache.contains(&self.key(key))
    }

    pub(crate) fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.cache.read(&self.key(key))
    }

    pub(crate) fn keep(&self, key: &[u8; 32], result: &[u8]) {
        if let Err(error) = self.cache.write(&self.key(key), result) {
            tracing::warn!("a result is not kept: {error}");
        }
    }

    fn key(&self, result: &[u8; 32]) -> CacheKey {
        let mut hash = blake3::Hasher::new_derive_key("sabi results of a program");
        hash.update(self.build.as_bytes());
        hash.update(result);
        *hash.finalize().as_bytes()
    }
}
