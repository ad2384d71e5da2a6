//! Default folder of the cache, which keeps results between runs to save time.

use std::path::PathBuf;

/// `SABI_CACHE_DIR`, else a `sabi` folder where the system keeps caches; none where it has no such place.
pub fn default_cache_dir() -> Option<PathBuf> {
    let variable = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    if let Some(own) = variable("SABI_CACHE_DIR") {
        return Some(own);
    }
    let system = if cfg!(windows) {
        variable("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        variable("HOME").map(|home| home.join("Library/Caches"))
    } else {
        variable("XDG_CACHE_HOME").or_else(|| variable("HOME").map(|home| home.join(".cache")))
    };
    system.map(|system| system.join("sabi"))
}
