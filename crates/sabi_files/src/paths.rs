//! Forms of a path: canonical, absolute, with links resolved, not yet in use.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::read::{Unread, read_plain};

/// Highest number that [`free_file`] appends.
const MAX_FREE_FILE_NUMBER: usize = 1000;

/// Returns the canonical path of an existing file or folder, without the `\\?\` prefix that Windows adds. An empty path is
/// the current folder.
///
/// # Errors
/// Nothing exists at the path, or it cannot be reached.
pub fn canonical(path: &Path) -> io::Result<PathBuf> {
    let path = if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    };
    path.canonicalize().map(without_prefix)
}

#[cfg(windows)]
fn without_prefix(path: PathBuf) -> PathBuf {
    let on_drive = path
        .to_str()
        .and_then(|text| text.strip_prefix(r"\\?\"))
        .filter(|rest| rest.as_bytes().get(1) == Some(&b':'))
        .map(PathBuf::from);
    // Network paths and names that are not Unicode work only with the prefix.
    on_drive.unwrap_or(path)
}

#[cfg(not(windows))]
fn without_prefix(path: PathBuf) -> PathBuf {
    path
}

/// Returns the path of the file that a symbolic link finally leads to. Other paths are returned unchanged.
pub fn behind_links(file: &Path) -> PathBuf {
    let is_link = fs::symlink_metadata(file).is_ok_and(|found| found.is_symlink());
    let target = is_link.then(|| canonical(file).ok()).flatten();
    // A link to a missing file has no canonical path. The link itself will be replaced.
    target.unwrap_or_else(|| file.to_owned())
}

/// Returns a path that stays valid when the current folder changes.
pub fn absolute(path: &Path) -> PathBuf {
    // This fails only for an empty path and without a current folder. Neither has an absolute form.
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns the first of `stem.ending`, `stem-2.ending`, … that does not exist or already contains these bytes; `None` if
/// 1000 of them are in use.
pub fn free_file(folder: &Path, stem: &OsStr, ending: &str, bytes: &[u8]) -> Option<PathBuf> {
    let numbers = (2..=MAX_FREE_FILE_NUMBER).map(|number| format!("-{number}"));
    let mut files = std::iter::once(String::new()).chain(numbers).map(|number| {
        let mut name = stem.to_owned();
        name.push(format!("{number}.{ending}"));
        folder.join(name)
    });
    // A file that is longer, or not an ordinary file, has another content.
    files.find(|file| match read_plain(file, bytes.len() as u64) {
        Ok(known) => known == bytes,
        Err(unread) => unread == Unread::Missing && fs::symlink_metadata(file).is_err(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_path_is_the_current_folder() {
        assert_eq!(canonical(Path::new("")).unwrap(), canonical(Path::new(".")).unwrap());
        assert!(canonical(Path::new("no such file")).is_err());
        assert!(absolute(Path::new("a")).is_absolute());
    }

    #[test]
    fn a_free_file_is_missing_or_has_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let free = |bytes: &[u8]| free_file(folder.path(), OsStr::new("rust"), "sabi", bytes).unwrap();
        let file = |name: &str| folder.path().join(name);
        assert_eq!(free(b"1"), file("rust.sabi"));
        fs::write(file("rust.sabi"), b"1").unwrap();
        assert_eq!(free(b"1"), file("rust.sabi"));
        assert_eq!(free(b"2"), file("rust-2.sabi"));
        fs::create_dir(file("rust-2.sabi")).unwrap();
        assert_eq!(free(b"2"), file("rust-3.sabi"));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_leads_to_its_file_and_a_broken_link_to_itself() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| canonical(folder.path()).unwrap().join(name);
        fs::write(file("file"), b"1").unwrap();
        std::os::unix::fs::symlink(file("file"), file("link")).unwrap();
        std::os::unix::fs::symlink(file("link"), file("chain")).unwrap();
        std::os::unix::fs::symlink(file("missing"), file("dangling")).unwrap();
        assert_eq!(behind_links(&file("chain")), file("file"));
        assert_eq!(behind_links(&file("file")), file("file"));
        assert_eq!(behind_links(&file("dangling")), file("dangling"));
        assert_eq!(behind_links(&file("missing")), file("missing"));
    }
}
