//! Encoded maps on disk: a map whose pixels did not change is not encoded again.

use std::path::Path;

use sabi_export::EncodedFiles;
use sabi_files::{Cache, CacheKey, CacheKind};

use crate::program::Build;

/// Version of the stored bytes.
const VERSION: u32 = 1;

/// Cache of encoded maps. Those of other programs are not found, since they may be encoded otherwise.
#[derive(Debug)]
pub(crate) struct EncodedCache {
    cache: Cache,
    build: &'static str,
}

impl EncodedCache {
    /// Opens the cache in a cache folder, with a limit of its size; `None` where the program is not known.
    pub(crate) fn open(cache_dir: &Path, limit_bytes: u64) -> Option<EncodedCache> {
        let kind = CacheKind {
            prefix: "map",
            version: VERSION,
            limit_bytes,
        };
        Some(EncodedCache {
            cache: Cache::new(cache_dir.join("maps"), kind),
            build: Build::current().blake3.as_deref()?,
        })
    }

    fn key(&self, file: &[u8; 32]) -> CacheKey {
        let mut hash = blake3::Hasher::new_derive_key("sabi encoded maps");
        hash.update(self.build.as_bytes());
        hash.update(file);
        *hash.finalize().as_bytes()
    }
}

impl EncodedFiles for EncodedCache {
    fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.cache.read(&self.key(key))
    }

    fn keep(&self, key: &[u8; 32], file: &[u8]) {
        if let Err(error) = self.cache.write(&self.key(key), file) {
            // The map itself is complete; the next bake encodes it again.
            tracing::warn!("an encoded map is not kept: {error}");
        }
    }
}
