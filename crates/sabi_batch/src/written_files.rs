//! Files that a matrix names, directly or by patterns.

use std::collections::{BTreeSet, HashSet};
use std::fs::{self, DirEntry};
use std::path::{Path, PathBuf};

use glob::{MatchOptions, Pattern};
use sabi_engine::phases::Progress;
use sabi_files::PathBase;

/// Maximum number of folder entries that are examined for all patterns of a matrix together.
const MOST_LOOKED_AT: usize = 1_000_000;

/// A file as a matrix names it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct WrittenFile {
    /// Path from the folder of the matrix, with `/` between folders.
    pub(crate) written: String,
    /// Path.
    pub(crate) path: PathBuf,
}

/// Rules for file names in a pattern, as in shells.
const SHELL: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

impl WrittenFile {
    /// Returns the file's name without folder and extension.
    pub(crate) fn stem(&self) -> String {
        let stem = self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        // A file has a name. A path without one is refused when it is read.
        stem.unwrap_or_default()
    }
}

/// Finds the files of paths and patterns, each once, in the order in which they are named; those of a pattern by name. Each entry of a
/// folder that a pattern leads past is counted in `looked_at`.
///
/// # Errors
/// A clause: a pattern fits no file, or is none.
pub(crate) fn written_files(
    base: &PathBase,
    patterns: &[String],
    looked_at: &mut usize,
    progress: &dyn Progress,
) -> Result<Vec<WrittenFile>, String> {
    let mut files: Vec<WrittenFile> = Vec::new();
    let mut known = HashSet::new();
    for written in patterns {
        let path = base.resolve(written);
        let found = match written.contains(['*', '?']) && !path.exists() {
            true => matching(base, written, looked_at, progress)?,
            false => vec![WrittenFile {
                written: written.replace('\\', "/"),
                path,
            }],
        };
        for file in found {
            if known.insert(file.path.clone()) {
                files.push(file);
            }
        }
    }
    Ok(files)
}

/// Finds the files that a pattern fits. The error is a clause.
fn matching(
    base: &PathBase,
    written: &str,
    looked_at: &mut usize,
    progress: &dyn Progress,
) -> Result<Vec<WrittenFile>, String> {
    let folder = base.folder();
    let mut files: Vec<WrittenFile> = Walk::new(folder, written, looked_at)?
        .files(progress)?
        .into_iter()
        .map(|path| {
            let below = path.strip_prefix(folder).unwrap_or(&path);
            WrittenFile {
                written: below.to_string_lossy().replace('\\', "/"),
                path,
            }
        })
        .collect();
    files.sort_by(|one, other| one.path.cmp(&other.path));
    match files.is_empty() {
        true => Err(format!("no file fits '{written}'")),
        false => Ok(files),
    }
}

/// A part of a pattern between two slashes.
enum PatternPart {
    /// Any number of folders, `**`.
    Folders,
    /// A name, or `..`.
    Name(String),
    Fitting(Pattern),
}

/// Search for the files that a pattern fits. It reads each folder once for each part of the pattern.
struct Walk<'p, 'l> {
    written: &'p str,
    parts: Vec<PatternPart>,
    /// Folders to read, each with the index of the part that their entries have to fit.
    open: Vec<(PathBuf, usize)>,
    known: HashSet<(PathBuf, usize)>,
    found: BTreeSet<PathBuf>,
    looked_at: &'l mut usize,
}

impl<'p, 'l> Walk<'p, 'l> {
    fn new(folder: &Path, written: &'p str, looked_at: &'l mut usize) -> Result<Walk<'p, 'l>, String> {
        let slashed = written.replace('\\', "/");
        let is_pattern = |part: &str| part.contains(['*', '?', '[']);
        // The parts before the first wildcard are a path, which may be absolute.
        let split = slashed.split('/').take_while(|part| !is_pattern(part));
        let length: usize = split.map(|part| part.len() + 1).sum();
        let (start, rest) = slashed.split_at(length.min(slashed.len()));
        let mut parts = Vec::new();
        for part in rest.split('/').filter(|part| !matches!(*part, "" | ".")) {
            parts.push(match part {
                "**" if matches!(parts.last(), Some(PatternPart::Folders)) => continue,
                "**" => PatternPart::Folders,
                part if is_pattern(part) => PatternPart::Fitting(
                    Pattern::new(part).map_err(|error| format!("'{written}' is no pattern: {}", error.msg))?,
                ),
                part => PatternPart::Name(part.to_owned()),
            });
        }
        let start = folder.join(start);
        Ok(Walk {
            written,
            parts,
            known: HashSet::from([(start.clone(), 0)]),
            open: vec![(start, 0)],
            found: BTreeSet::new(),
            looked_at,
        })
    }

    fn files(mut self, progress: &dyn Progress) -> Result<BTreeSet<PathBuf>, String> {
        while let Some((folder, at)) = self.open.pop() {
            let is_last = at + 1 == self.parts.len();
            match self.parts.get(at) {
                None => {}
                Some(PatternPart::Name(name)) => {
                    let path = folder.join(name);
                    self.take(path, at, is_last);
                }
                Some(PatternPart::Folders) => {
                    if !is_last {
                        self.go(folder.clone(), at + 1);
                    }
                    for entry in self.entries(&folder, progress)? {
                        // Links may lead in circles.
                        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
                        if is_folder && !entry.file_name().to_string_lossy().starts_with('.') {
                            self.go(folder.join(entry.file_name()), at);
                        }
                    }
                }
                Some(PatternPart::Fitting(pattern)) => {
                    let pattern = pattern.clone();
                    for entry in self.entries(&folder, progress)? {
                        if pattern.matches_with(&entry.file_name().to_string_lossy(), SHELL) {
                            self.take(folder.join(entry.file_name()), at, is_last);
                        }
                    }
                }
            }
        }
        Ok(self.found)
    }

    /// Adds a path that fits all parts up to this one.
    fn take(&mut self, path: PathBuf, at: usize, is_last: bool) {
        match is_last {
            true if path.is_file() => drop(self.found.insert(path)),
            false if path.is_dir() => self.go(path, at + 1),
            _ => {}
        }
    }

    fn go(&mut self, folder: PathBuf, at: usize) {
        if self.known.insert((folder.clone(), at)) {
            self.open.push((folder, at));
        }
    }

    /// Lists a folder; empty if the folder cannot be read, since nothing in it could be baked.
    fn entries(&mut self, folder: &Path, progress: &dyn Progress) -> Result<Vec<DirEntry>, String> {
        let mut found = Vec::new();
        // For a matrix without a folder in its path, it is the current folder.
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            *self.looked_at += 1;
            if *self.looked_at > MOST_LOOKED_AT {
                let written = self.written;
                return Err(format!(
                    "'{written}' leads past more than {MOST_LOOKED_AT} files, with the patterns before it; begin it with the folder of those that are meant"
                ));
            }
            if progress.is_canceled() {
                return Err("it was canceled".to_owned());
            }
            found.push(entry);
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sabi_engine::phases::{NoProgress, Phase};

    #[test]
    fn a_pattern_gives_its_files_by_name_and_each_file_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().join("odd [1]");
        for file in [
            "m/b2.glb",
            "m/b10.glb",
            "m/b1.glb",
            "m/.b0.glb",
            "m/deep/b3.glb",
            "m/a.txt",
        ] {
            let path = root.join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, "").expect("written");
        }
        let base = PathBase::of_folder(&root);
        let of = |patterns: &[&str]| {
            let patterns: Vec<String> = patterns.iter().map(|text| (*text).to_owned()).collect();
            let files = written_files(&base, &patterns, &mut 0, &NoProgress)?;
            Ok::<_, String>(files.into_iter().map(|file| file.written).collect::<Vec<_>>())
        };
        let names = |names: &[&str]| Ok(names.iter().map(|name| (*name).to_owned()).collect());
        assert_eq!(of(&["m/b*.glb"]), names(&["m/b1.glb", "m/b10.glb", "m/b2.glb"]));
        assert_eq!(of(&["m/b2.glb", "m/b?.glb"]), names(&["m/b2.glb", "m/b1.glb"]));
        assert_eq!(of(&["**/b3.glb"]), names(&["m/deep/b3.glb"]));
        assert_eq!(
            of(&["**/**/**/b*.glb"]),
            names(&["m/b1.glb", "m/b10.glb", "m/b2.glb", "m/deep/b3.glb"])
        );
        assert_eq!(
            of(&["*/./deep/../b[12].glb"]),
            names(&["m/deep/../b1.glb", "m/deep/../b2.glb"])
        );
        let absolute = format!("{}/**/b3.glb", root.display());
        assert_eq!(
            of(&[&absolute]),
            Err(format!("no file fits '{absolute}'")),
            "its folder looks like a pattern"
        );
        assert_eq!(of(&["gone.glb"]), names(&["gone.glb"]), "whoever reads it says so");
        assert_eq!(of(&["m/c*.glb"]), Err("no file fits 'm/c*.glb'".to_owned()));
    }

    /// Progress that is canceled after it has been asked this many times.
    struct After(std::sync::atomic::AtomicUsize);

    impl Progress for After {
        fn advance(&self, _: Phase, _: usize, _: usize) {}

        fn is_canceled(&self) -> bool {
            self.0.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) == 0
        }
    }

    #[test]
    fn a_pattern_that_leads_through_the_whole_disk_can_be_canceled() {
        let base = PathBase::of_folder("/");
        let patterns = ["/**/**/**/*.no-such-ending".to_owned()];
        let told = written_files(&base, &patterns, &mut 0, &After(20.into()));
        assert_eq!(told, Err("it was canceled".to_owned()));
    }

    #[cfg(unix)]
    #[test]
    fn links_of_folders_in_a_circle_do_not_multiply_files() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("a")).expect("made");
        fs::write(folder.path().join("a/x.glb"), "").expect("written");
        std::os::unix::fs::symlink("..", folder.path().join("a/up")).expect("linked");
        let base = PathBase::of_folder(folder.path());
        let found = written_files(&base, &["**/**/*.glb".to_owned()], &mut 0, &NoProgress).expect("one file");
        assert_eq!(found.len(), 1);
        // The limit applies to all patterns together.
        let mut looked_at = MOST_LOOKED_AT;
        let told = written_files(&base, &["**/*.glb".to_owned()], &mut looked_at, &NoProgress);
        assert!(told.expect_err("over").contains("with the patterns before it"));
    }
}
