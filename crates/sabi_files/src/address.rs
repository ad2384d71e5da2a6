//! Texts and paths that do not refer to an ordinary file on this computer.

use std::ffi::OsStr;
use std::path::Path;

/// Folders of devices and of files whose content a Unix system generates when they are read.
const DEVICE_FOLDERS: [&str; 3] = ["/dev", "/proc", "/sys"];
/// Folder inside `/dev` that contains ordinary files in memory.
const MEMORY_FOLDER: &str = "/dev/shm";
/// Names that are devices in every folder on Windows, whatever their extension. COM and LPT are followed by a digit.
const DEVICE_NAMES: [&str; 6] = ["con", "prn", "aux", "nul", "conin$", "conout$"];
const NUMBERED_DEVICES: [&str; 2] = ["com", "lpt"];

/// Returns true if a text that refers to a file may be looked up: it is not a network address, for which even looking up
/// the file would send the user's name.
pub fn is_local(written: &str) -> bool {
    !leads_to_network(written) && !is_url(written)
}

/// Returns true if a text is a path of another computer or of the Windows device namespace. This is checked on every
/// system: such a text starts with two slashes of either kind, like `\\host\share`, `\\?\UNC\host\share` and `\\.\COM1`.
pub(crate) fn leads_to_network(written: &str) -> bool {
    let mut start = written.trim_start().chars();
    let is_slash = |letter: Option<char>| matches!(letter, Some('/' | '\\'));
    is_slash(start.next()) && is_slash(start.next())
}

/// Returns true if a text is a URL. A single letter before a colon is a drive.
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

/// Returns true if an absolute path without `.` and `..` is the path of a device.
pub(crate) fn is_device(path: &Path) -> bool {
    if cfg!(windows) {
        path.components().any(|part| is_device_name(part.as_os_str()))
    } else {
        let is_below = |folder: &str| path.starts_with(folder);
        DEVICE_FOLDERS.into_iter().any(is_below) && !is_below(MEMORY_FOLDER)
    }
}

/// Returns true if Windows treats a name as a device.
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
