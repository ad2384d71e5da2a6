//! Cache of encoded maps on disk. A map whose pixels have not changed is not encoded again.

use std::path::Path;

use sabi_export::EncodedFiles;
use sabi_files::Disk;

use crate::program_cache::ProgramCache;

/// Cache of encoded maps.
#[derive(Debug)]
pub(crate) struct EncodedCache(ProgramCache);

impl EncodedCache {
    /// Opens the cache in a cache folder on a disk, with a size limit. `None` if this program cannot be identified.
    pub(crate) fn open(disk: &Disk, cache_dir: &Path, limit_bytes: u64) -> Option<EncodedCache> {
        let cache = ProgramCache::open(cache_dir, "maps", "map", limit_bytes);
        cache.map(|cache| EncodedCache(cache.on_disk(disk)))
    }
}

impl EncodedFiles for EncodedCache {
    fn find(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.0.find(key)
    }

    fn keep(&self, key: &[u8; 32], file: &[u8]) {
        self.0.keep(key, file);
    }
}
