//! Default folder of the cache, which keeps results between runs to save time.

use std::path::PathBuf;

use crate::error::{EngineError, ErrorKind};
use crate::opening::own_folder::SystemFolders;

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
    cache_dir(&SystemFolders::of_environment())
}

fn cache_dir(folders: &SystemFolders<'_>) -> Option<PathBuf> {
    let own = folders.own("SABI_CACHE_DIR");
    own.or_else(|| {
        Some(
            folders
                .system(["LOCALAPPDATA", "Library/Caches", "XDG_CACHE_HOME", ".cache"])?
                .join("sabi"),
        )
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::cache_dir;
    use crate::opening::own_folder::SystemFolders;

    #[test]
    #[cfg(target_os = "linux")]
    fn relative_folders_of_the_system_are_ignored() {
        let found = |own: &str, xdg: &str, home: &str| {
            let variable = |name: &str| match name {
                "SABI_CACHE_DIR" => Some(own.into()),
                "XDG_CACHE_HOME" => Some(xdg.into()),
                "HOME" => Some(home.into()),
                _ => None,
            };
            cache_dir(&SystemFolders { variable: &variable })
        };
        assert_eq!(found("", "/x", "/h"), Some(PathBuf::from("/x/sabi")));
        for ignored in ["", "relative", "./x", "~/x"] {
            assert_eq!(
                found("", ignored, "/h"),
                Some(PathBuf::from("/h/.cache/sabi")),
                "{ignored}"
            );
        }
        assert_eq!(found("", "x", "h"), None);
        // The variable of Sabi itself may start from the current folder.
        assert_eq!(found("own", "/x", "/h"), Some(PathBuf::from("own")));
    }
}
