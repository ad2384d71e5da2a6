//! Texts and paths that lead to no ordinary file of this computer.

use std::ffi::OsStr;
use std::path::Path;

/// Folders of devices, and of files that a Unix system makes up when they are read.
const DEVICE_FOLDERS: [&str; 3] = ["/dev", "/proc", "/sys"];
/// Folder of ordinary files in memory among those.
const MEMORY_FOLDER: &str = "/dev/shm";
/// Names that are devices in every folder of Windows, whatever their ending; COM and LPT have a digit.
const DEVICE_NAMES: [&str; 6] = ["con", "prn", "aux", "nul", "conin$", "conout$"];
const NUMBERED_DEVICES: [&str; 2] = ["com", "lpt"];

/// Returns true if a text that names a file can be looked up: it is no address of the network, where even looking for a file sends
/// the name of the user.
pub fn is_local(written: &str) -> bool {
    !leads_to_network(written) && !is_url(written)
}

/// Returns true if a text is a path of another computer or of the device namespace of Windows, on whatever system: it begins with
/// two slashes of either kind, as `\\host\share`, `\\?\UNC\host\share` and `\\.\COM1` do.
pub(crate) fn leads_to_network(written: &str) -> bool {
    let mut start = written.trim_start().chars();
    let is_slash = |letter: Option<char>| matches!(letter, Some('/' | '\\'));
    is_slash(start.next()) && is_slash(start.next())
}

/// Returns true if a text is a URL; a single letter before the colon is a drive.
pub(crate) fn is_url(written: &str) -> bool {
    let Some((scheme, rest)) = written.trim_start().split_once(':') else {
        return false;
    };
    let is_scheme = scheme.len() > 1
        && scheme
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || b"+.-".contains(&byte));
    is_scheme && (rest.starts_with("//") || scheme.eq_ignore_ascii_case("file"))
}

/// Returns true if an absolute path without detours is that of a device.
pub(crate) fn is_device(path: &Path) -> bool {
    if cfg!(windows) {
        path.components().any(|part| is_device_name(part.as_os_str()))
    } else {
        let is_below = |folder: &str| path.starts_with(folder);
        DEVICE_FOLDERS.into_iter().any(is_below) && !is_below(MEMORY_FOLDER)
    }
}

/// Returns true if Windows takes a name for a device.
pub(crate) fn is_device_name(name: &OsStr) -> bool {
    let name = name.to_string_lossy().to_lowercase();
    let stem = name.split(['.', ':']).next().unwrap_or(&name).trim_end();
    let is_numbered = |device: &str| {
        let number = stem.strip_prefix(device);
        number.is_some_and(|number| {
            matches!(number, "¹" | "²" | "³") || number.len() == 1 && number.parse::<u8>().is_ok()
        })
    };
    DEVICE_NAMES.contains(&stem) || NUMBERED_DEVICES.into_iter().any(is_numbered)
}
