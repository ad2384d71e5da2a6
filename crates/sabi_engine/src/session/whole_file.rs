//! Files that are there whole or as they were before.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// No more files of one name are looked at.
const MOST_OF_A_NAME: usize = 1000;

/// Writes a file under a name of its own and puts it in place then, so that nobody ever reads half of it. Folders are made, and
/// a link stays one: the file that it leads to is written.
///
/// # Errors
/// The folder cannot be written to; the file is as it was before.
pub fn write_whole(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let file = &behind_links(file);
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let partial = file.with_file_name(name);
    let written = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, file));
    if written.is_err() {
        // It may never have come to be; the first error is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    written
}

/// A path by the one name of what it leads to, written as people write it: Windows has another spelling for its own use. One
/// without a name, such as the folder of a file that has none before it, is where the program was started.
///
/// # Errors
/// Nothing is there, or it cannot be reached.
pub fn canonical(path: &Path) -> io::Result<PathBuf> {
    let path = if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    };
    path.canonicalize().map(|path| without_prefix(&path))
}

fn without_prefix(path: &Path) -> PathBuf {
    let text = path.to_string_lossy();
    let on_drive = text
        .strip_prefix(r"\\?\")
        .filter(|rest| rest.as_bytes().get(1) == Some(&b':'));
    on_drive.map_or_else(|| path.to_owned(), PathBuf::from)
}

/// The file that a link leads to, however many there are in between; every other path as it is.
pub(crate) fn behind_links(file: &Path) -> PathBuf {
    let is_link = fs::symlink_metadata(file).is_ok_and(|found| found.is_symlink());
    let behind = is_link.then(|| canonical(file).ok()).flatten();
    behind.unwrap_or_else(|| file.to_owned())
}

/// A path that leads to the same from wherever the program is started next.
pub(crate) fn rooted(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// The first of `stem.sabi`, `stem-2.sabi` and so on that is not there, or that holds these very bytes; none where there are
/// too many.
pub fn free_graph_file(folder: &Path, stem: &str, bytes: &[u8]) -> Option<PathBuf> {
    let others = (2..=MOST_OF_A_NAME).map(|number| format!("{stem}-{number}"));
    let files = std::iter::once(stem.to_owned()).chain(others);
    let is_free = |file: &PathBuf| match fs::read(file) {
        Ok(known) => known == bytes,
        Err(error) => error.kind() == io::ErrorKind::NotFound,
    };
    files.map(|stem| folder.join(format!("{stem}.sabi"))).find(is_free)
}
