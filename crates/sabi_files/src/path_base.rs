//! Paths that are written in files: resolving and writing them.
//!
//! In a file both `/` and `\` separate folders, whatever system wrote it. Relative paths refer to the folder of the file
//! that contains them.

use std::fs;
use std::path::{Component, Path, PathBuf};

use icu_normalizer::ComposingNormalizerBorrowed;
use thiserror::Error;

use crate::address::is_local;

/// Folder to which the relative paths in a file refer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathBase {
    folder: PathBuf,
}

/// Path that cannot be written in a text file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{} cannot be named in a file, because its name is not Unicode text; rename it", path.display())]
pub struct NotText {
    /// The path.
    pub path: PathBuf,
}

/// Treatment of absolute paths when the file that contains them moves to another folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbsolutePaths {
    /// They stay absolute.
    Keep,
    /// Absolute paths that share more than the root with the new folder become relative.
    Shorten,
}

impl PathBase {
    /// Creates the base for files in a folder.
    pub fn of_folder(folder: impl Into<PathBuf>) -> PathBase {
        PathBase { folder: folder.into() }
    }

    /// Creates the base for a file: its folder.
    pub fn of_file(file: &Path) -> PathBase {
        // A path without a folder is relative to the current folder, and so is its base.
        PathBase::of_folder(file.parent().unwrap_or(Path::new("")))
    }

    /// Folder of the base.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the file that a path refers to. A backslash is part of a name only if a file with that name exists.
    pub fn resolve(&self, written: &str) -> PathBuf {
        let literal = self.folder.join(written);
        if !written.contains('\\') || is_local(written) && literal.exists() {
            return literal;
        }
        self.folder.join(with_forward_slashes(written))
    }

    /// Returns the base for a file to which this base's file refers.
    pub fn base_of(&self, written: &str) -> PathBase {
        PathBase::of_file(&self.resolve(written))
    }

    /// Returns possible places of a file to which a model refers, with their texts, most likely first: as written; with `/` between
    /// folders; and by its bare file name in the model's folder, since models often contain paths of the computer on which they were made.
    pub fn places(&self, written: &str) -> [(String, PathBuf); 3] {
        let slashed = with_forward_slashes(written);
        let bare = slashed.rsplit('/').next().unwrap_or(&slashed).to_owned();
        [written.to_owned(), slashed, bare].map(|text| {
            let place = self.folder.join(&text);
            (text, place)
        })
    }

    /// Returns the place below the folder of this base to which a path leads in another case or composition of letters, with the path as it is there;
    /// `None` where there is none, or where it leads above the folder. Systems that tell no cases apart write any.
    pub fn place_in_other_case(&self, written: &str) -> Option<(String, PathBuf)> {
        let (mut text, mut place) = (String::new(), self.folder.clone());
        for part in Path::new(written).components() {
            let name = match part {
                Component::CurDir => continue,
                Component::Normal(name) => name.to_str()?,
                Component::Prefix(_) | Component::RootDir | Component::ParentDir => return None,
            };
            let exact = place.join(name);
            let name = match exact.exists() {
                true => name.to_owned(),
                false => name_in_other_case(&place, name)?,
            };
            if !text.is_empty() {
                text.push('/');
            }
            text.push_str(&name);
            place.push(name);
        }
        (!text.is_empty()).then_some((text, place))
    }

    /// Writes an existing or future file's path for a file of this base: relative where both share more than the root.
    /// Both paths are absolute.
    ///
    /// # Errors
    /// A part of the path is not Unicode.
    pub fn write(&self, target: &Path) -> Result<String, NotText> {
        let folder = without_detours(&self.folder);
        let [there, here] = [target, &folder].map(|path| path.components().collect::<Vec<_>>());
        let shared = shared_components(&there, &here);
        if !has_shared_folder(&there[..shared]) {
            return path_text(target);
        }
        path_text(&relative_path(&there, &here, shared))
    }

    /// Rewrites a path from a file of the base `from` so that it refers to the same file from this base. An empty path
    /// stays unchanged, and so does an absolute path that is to be kept.
    ///
    /// # Errors
    /// A part of the path is not Unicode.
    pub fn rewrite(&self, written: &str, from: &PathBase, absolute: AbsolutePaths) -> Result<String, NotText> {
        let slashed = with_forward_slashes(written);
        let has_drive = slashed.as_bytes().get(1) == Some(&b':');
        let is_absolute = slashed.starts_with('/') || has_drive;
        if written.trim().is_empty() || is_absolute && absolute == AbsolutePaths::Keep {
            return Ok(written.to_owned());
        }
        let target = without_detours(&from.folder.join(&slashed));
        let folder = without_detours(&self.folder);
        let [there, here] = [&target, &folder].map(|path| path.components().collect::<Vec<_>>());
        let shared = shared_components(&there, &here);
        if is_absolute && !has_shared_folder(&there[..shared]) {
            return Ok(written.to_owned());
        }
        if shared == 0 {
            // The target is on another drive, or below another relative folder.
            return path_text(&target);
        }
        path_text(&relative_path(&there, &here, shared))
    }

    /// Rewrites a path from a file of this base as an absolute path, which is valid everywhere. An empty path stays empty.
    /// The base's folder must be absolute.
    ///
    /// # Errors
    /// A part of the path is not Unicode.
    pub fn rewrite_absolute(&self, written: &str) -> Result<String, NotText> {
        if written.trim().is_empty() {
            return Ok(written.to_owned());
        }
        path_text(&without_detours(&self.folder.join(with_forward_slashes(written))))
    }
}

/// Removes `.` and resolves `..` in the text of a path, as far as possible without examining links.
pub fn without_detours(path: &Path) -> PathBuf {
    let mut direct = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(direct.components().next_back(), Some(Component::Normal(_))) => {
                direct.pop();
            }
            // The root has no parent.
            Component::ParentDir if direct.has_root() => {}
            part => direct.push(part),
        }
    }
    direct
}

/// Most entries of a folder among which a name in another case is looked for.
const MOST_ENTRIES: usize = 4096;

/// Returns the entry of a folder that has a name in another case of letters, of several the first by the alphabet.
fn name_in_other_case(folder: &Path, name: &str) -> Option<String> {
    // The base of a file without a folder is the current one.
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let alike = folded(name);
    let entries = fs::read_dir(folder).ok()?.take(MOST_ENTRIES).flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|other| folded(other) == alike).min()
}

/// Returns a name without its differences of case and of composition: systems write `é` as one letter or as `e` and an accent.
pub(crate) fn folded(name: &str) -> String {
    ComposingNormalizerBorrowed::new_nfc().normalize(name).to_lowercase()
}

fn with_forward_slashes(written: &str) -> String {
    written.replace('\\', "/")
}

/// Number of leading components that two paths share.
fn shared_components(one: &[Component<'_>], other: &[Component<'_>]) -> usize {
    one.iter().zip(other).take_while(|(one, other)| one == other).count()
}

/// Returns true if the shared components contain a folder, not only a root.
fn has_shared_folder(shared: &[Component<'_>]) -> bool {
    shared.iter().any(|part| matches!(part, Component::Normal(_)))
}

/// Returns the path from one folder to a target: up to the shared folder, then down to the target.
fn relative_path(there: &[Component<'_>], here: &[Component<'_>], shared: usize) -> PathBuf {
    let up = std::iter::repeat_n(Component::ParentDir, here.len() - shared);
    up.chain(there[shared..].iter().copied()).collect()
}

/// Returns the text of a path with `/` between folders.
///
/// # Errors
/// A part of the path is not Unicode.
pub fn path_text(path: &Path) -> Result<String, NotText> {
    let text = path.to_str().ok_or_else(|| NotText { path: path.to_owned() })?;
    Ok(if cfg!(windows) {
        with_forward_slashes(text)
    } else {
        text.to_owned()
    })
}

#[cfg(test)]
mod tests;
