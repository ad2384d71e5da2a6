//! Default folder of the cache, which keeps results between runs to save time.

use std::path::PathBuf;

use crate::error::{EngineError, ErrorKind};

/// Default limit for the results of nodes, and for encoded maps, in a cache folder, in MiB each.
const DEFAULT_BUDGET_MIB: u64 = 4096;
const BUDGET_VARIABLE: &str = "SABI_CACHE_MIB";

/// Maximum number of bytes of results of nodes in a cache folder, which is also the maximum for encoded maps:
/// `SABI_CACHE_MIB`, otherwise 4 GiB.
///
/// # Errors
/// The variable is no number.
pub(crate) fn cache_budget_bytes() -> Result<u64, EngineError> {
    let Some(text) = std::env::var_os(BUDGET_VARIABLE).filter(|text| !text.is_empty()) else {
        return Ok(DEFAULT_BUDGET_MIB << 20);
    };
    let mib = text.to_str().and_then(|text| text.parse::<u64>().ok());
    let bytes = mib.and_then(|mib| mib.checked_mul(1 << 20));
    bytes.ok_or_else(|| {
        let why = format!(
            "{BUDGET_VARIABLE} takes a number of MiB, not '{}'",
            text.to_string_lossy()
        );
        EngineError::new(ErrorKind::Usage, why)
    })
}

/// Returns `SABI_CACHE_DIR`, otherwise a `sabi` folder in the system's folder for caches; `None` if the system has none.
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
