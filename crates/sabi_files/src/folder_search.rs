//! Search of a folder, and of the folders below it, by the names of files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use sabi_cancel::look;

use crate::address::leads_to_network;
use crate::path_base::folded;
use crate::read::Unread;
use crate::refusal::Refusal;
use crate::trusted_paths::TrustedPaths;

/// Most files and folders that are looked at.
const MOST_ENTRIES: usize = 100_000;
/// Most folders below each other.
const MOST_LEVELS: usize = 16;

/// Search of a folder by the names of files. It is listed for the first name. Of files with one name, that in the fewest folders is
/// found; case does not count.
#[derive(Clone, Debug)]
pub struct FolderSearch {
    folder: PathBuf,
    listed: Option<Result<BTreeMap<String, PathBuf>, Unread>>,
}

impl FolderSearch {
    /// A search of this folder.
    pub fn new(folder: &Path) -> FolderSearch {
        FolderSearch {
            folder: folder.to_owned(),
            listed: None,
        }
    }

    /// Finds the file with the name at the end of a path, whichever system the path was written on.
    ///
    /// # Errors
    /// There is no such file, or the folder or the file may not be opened.
    pub fn find(&mut self, trusted: &TrustedPaths, written: &str) -> Result<PathBuf, Unread> {
        let listed = self.listed.get_or_insert_with(|| {
            check(&self.folder, trusted)?;
            Ok(files_below(&self.folder))
        });
        let files = listed.as_ref().map_err(Clone::clone)?;
        let name = written.rsplit(['/', '\\']).next().unwrap_or(written);
        let place = files.get(&folded(name)).ok_or(Unread::Missing)?;
        trusted.check_found(place)?;
        Ok(place.clone())
    }
}

fn check(folder: &Path, trusted: &TrustedPaths) -> Result<(), Unread> {
    let written = folder.to_string_lossy();
    if leads_to_network(&written) {
        let written = written.into_owned();
        return Err(Unread::Refused(Refusal::Network { written }));
    }
    trusted.check_found(folder).map(drop)
}

/// Files in a folder and below it by their names without differences of case and composition. Links to folders are not followed, and folders that cannot be listed
/// have no files.
fn files_below(folder: &Path) -> BTreeMap<String, PathBuf> {
    let mut files = BTreeMap::new();
    let mut level = vec![folder.to_owned()];
    let mut left = MOST_ENTRIES;
    for _ in 0..MOST_LEVELS {
        let mut below = Vec::new();
        for folder in level {
            look();
            let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
            let mut entries: Vec<fs::DirEntry> = entries.take(left).collect();
            left -= entries.len();
            entries.sort_by_key(fs::DirEntry::file_name);
            for entry in entries {
                let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
                if is_folder {
                    below.push(entry.path());
                } else if let Ok(name) = entry.file_name().into_string() {
                    files.entry(folded(&name)).or_insert_with(|| entry.path());
                }
            }
        }
        level = below;
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_found_by_its_name_in_the_fewest_folders() {
        let folder = tempfile::tempdir().unwrap();
        let at = |place: &str| folder.path().join(place);
        fs::create_dir_all(at("a/b")).unwrap();
        for file in ["a/b/Wood.PNG", "a/wood.png", "a/b/rust.png"] {
            fs::write(at(file), "x").unwrap();
        }
        let trusted = TrustedPaths::default().with_path(folder.path());
        let mut search = FolderSearch::new(folder.path());
        for (written, found) in [
            ("wood.png", Ok(at("a/wood.png"))),
            (r"D:\textures\RUST.png", Ok(at("a/b/rust.png"))),
            ("/media/textures/rust.png", Ok(at("a/b/rust.png"))),
            ("gone.png", Err(Unread::Missing)),
            ("", Err(Unread::Missing)),
        ] {
            assert_eq!(search.find(&trusted, written), found, "{written}");
        }
    }

    #[test]
    fn a_folder_that_is_not_trusted_or_missing_is_not_searched() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("wood.png"), "x").unwrap();
        let find = |folder: &Path| FolderSearch::new(folder).find(&TrustedPaths::default(), "wood.png");
        assert!(matches!(
            find(folder.path()),
            Err(Unread::Refused(Refusal::Outside { .. }))
        ));
        assert_eq!(find(&folder.path().join("gone")), Err(Unread::Missing));
        assert!(matches!(
            find(Path::new(r"\\server\share")),
            Err(Unread::Refused(Refusal::Network { .. }))
        ));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_out_of_the_folder_is_no_way_around_trust() {
        let [folder, outside] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        fs::write(outside.path().join("wood.png"), "x").unwrap();
        let trusted = TrustedPaths::default().with_path(folder.path());
        std::os::unix::fs::symlink(outside.path().join("wood.png"), folder.path().join("wood.png")).unwrap();
        std::os::unix::fs::symlink(outside.path(), folder.path().join("linked")).unwrap();
        let found = FolderSearch::new(folder.path()).find(&trusted, "wood.png");
        assert!(
            matches!(found, Err(Unread::Refused(Refusal::Outside { .. }))),
            "{found:?}"
        );
    }
}
