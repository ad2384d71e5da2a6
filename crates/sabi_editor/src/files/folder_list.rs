//! Folders and files to choose from.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::paths::lowercase_ending;

/// Most entries that are listed.
const MOST_ENTRIES: usize = 2000;
/// Time after which a folder is read again.
const FRESH: Duration = Duration::from_secs(2);

/// A folder or a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FolderEntry {
    /// False for folders, which come first.
    pub(super) is_file: bool,
    pub(super) name: String,
}

/// Contents of one folder, as far as they can be chosen.
#[derive(Default)]
pub(super) struct FolderList {
    /// Folder and endings that were listed, and when.
    read: Option<(PathBuf, Vec<String>, Instant)>,
    entries: Vec<FolderEntry>,
    /// Reason why the folder cannot be listed.
    fault: Option<String>,
}

impl FolderList {
    /// Entries of a folder: its folders, then its files with one of these endings, each sorted by name. Hidden ones are left
    /// out.
    ///
    /// # Errors
    /// A sentence, where the folder cannot be read.
    pub(super) fn of(&mut self, folder: &Path, endings: &[&str]) -> Result<&[FolderEntry], &str> {
        let is_fresh = |(known, of, at): &(PathBuf, Vec<String>, Instant)| {
            known == folder && of == endings && at.elapsed() < FRESH
        };
        if !self.read.as_ref().is_some_and(is_fresh) {
            let of = endings.iter().map(|ending| (*ending).to_owned()).collect();
            self.read = Some((folder.to_owned(), of, Instant::now()));
            match listed(folder, endings) {
                Ok(entries) => (self.entries, self.fault) = (entries, None),
                Err(error) => self.fault = Some(format!("This folder cannot be read: {error}")),
            }
        }
        match &self.fault {
            Some(fault) => Err(fault),
            None => Ok(&self.entries),
        }
    }
}

fn listed(folder: &Path, endings: &[&str]) -> std::io::Result<Vec<FolderEntry>> {
    let entries = fs::read_dir(folder)?.filter_map(|entry| {
        let path = entry.ok()?.path();
        // A name that is not Unicode cannot be typed; the system's dialog gives it.
        let name = path.file_name()?.to_str()?.to_owned();
        let is_file = !path.is_dir();
        let is_wanted = || lowercase_ending(&path).is_some_and(|ending| endings.contains(&ending.as_str()));
        (!name.starts_with('.') && (!is_file || is_wanted())).then_some(FolderEntry { is_file, name })
    });
    let mut entries: Vec<FolderEntry> = entries.take(MOST_ENTRIES).collect();
    entries.sort_by_key(|entry| (entry.is_file, entry.name.to_lowercase()));
    Ok(entries)
}

/// Longest common beginning of all names that begin with `part`, whatever its case; `None` if there are no such names.
pub(super) fn completed<'n>(part: &str, names: impl Iterator<Item = &'n str>) -> Option<String> {
    let lower = part.to_lowercase();
    let mut fitting = names.filter(|name| name.to_lowercase().starts_with(&lower));
    let first = fitting.next()?.to_owned();
    let common = fitting.fold(first, |common, name| {
        let pairs = common.chars().zip(name.chars());
        let same = pairs.take_while(|(one, other)| one.to_lowercase().eq(other.to_lowercase()));
        same.map(|(one, _)| one).collect()
    });
    Some(common).filter(|common| common != part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_come_first_and_only_files_that_fit_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["b.sabi", "A.SABI", "note.txt", ".hidden.sabi"] {
            fs::write(folder.path().join(name), "").expect("a file");
        }
        fs::create_dir(folder.path().join("zoo")).expect("a folder");
        let mut list = FolderList::default();
        let entries = list.of(folder.path(), &["sabi"]).expect("entries");
        let names: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, ["zoo", "A.SABI", "b.sabi"]);
        let gone = list.of(&folder.path().join("gone"), &["sabi"]).expect_err("no folder");
        assert!(gone.starts_with("This folder cannot be read: "), "{gone}");
    }

    #[test]
    fn a_name_is_completed_up_to_where_the_matching_names_differ() {
        let names = ["rust.sabi", "rusty-metal.sabi", "Wood"];
        let completed = |part: &str| completed(part, names.into_iter());
        assert_eq!(completed("ru").as_deref(), Some("rust"));
        assert_eq!(completed("rust"), None, "two names begin with it");
        assert_eq!(completed("rusty").as_deref(), Some("rusty-metal.sabi"));
        assert_eq!(completed("wo").as_deref(), Some("Wood"));
        assert_eq!(completed("x"), None);
    }
}
