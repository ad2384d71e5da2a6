//! Absolute paths of files that a file or the user names.

use std::path::{Path, PathBuf};

use crate::address::is_local;
use crate::path_base::{PathBase, without_detours};
use crate::paths::{absolute, canonical};

/// Returns the absolute path of a file that a file names, without `.` and `..`.
pub fn whole_path(base: &PathBase, written: &str) -> PathBuf {
    let read = base.resolve(written);
    let direct = without_detours(&absolute(&read));
    if !is_local(written) {
        return direct;
    }
    match (canonical(&direct), canonical(&read)) {
        // Behind a link to a folder, `..` may lead elsewhere than its text suggests.
        (there, Ok(real)) if there.as_ref().ok() != Some(&real) => real,
        _ => direct,
    }
}

/// Returns the absolute path of a file that the user names. Links to its folder are resolved, but not the file itself, whose name matters.
pub fn named_path(path: &Path) -> PathBuf {
    let folder = path.parent().unwrap_or(Path::new("")); // A bare name refers to the current folder.
    match (canonical(folder), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => absolute(path),
    }
}
