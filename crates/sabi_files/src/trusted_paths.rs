//! Decision whether a file to which another file refers may be opened.
//!
//! A graph or a model may come from an unknown source, and the files that it refers to are displayed, baked and copied. Therefore it can
//! only reach files below its own folder, and below files and folders that the user has named. All others are refused with a sentence.
//! Links and `..` are resolved before the decision. Network addresses and devices are always refused.

mod project;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use self::project::{Homes, project_of};
use crate::address::{is_device, is_url, leads_to_network};
use crate::path_base::{PathBase, without_detours};
use crate::paths::{absolute, canonical};
use crate::read::{Unread, read_plain, unread};
use crate::refusal::Refusal;

/// Files and folders whose content may be opened by any file that refers to them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TrustedPaths {
    /// Canonical paths. A folder stands for everything below it.
    paths: BTreeSet<PathBuf>,
}

impl TrustedPaths {
    /// Returns the paths that become trusted when the user names a file, for example a graph on the command line.
    pub fn of_file(file: &Path) -> TrustedPaths {
        TrustedPaths::default().with_file(file)
    }

    /// Adds the folder of a file that the user has named, and the project that contains it: the nearest folder above with a repository
    /// (`.git`) of the user or with `sabi.toml`. The home folder and the folders above it never count as a project.
    #[must_use]
    pub fn with_file(mut self, file: &Path) -> TrustedPaths {
        // A path without a folder is relative to the current folder.
        if let Ok(folder) = canonical(file.parent().unwrap_or(Path::new(""))) {
            self.paths
                .extend(project_of(&folder, Homes::of_user()).map(Path::to_owned));
            self.paths.insert(folder);
        }
        self
    }

    /// Adds a file or folder that the user trusts. A path that does not exist is not added.
    #[must_use]
    pub fn with_path(mut self, path: &Path) -> TrustedPaths {
        self.paths.extend(canonical(path));
        self
    }

    /// Adds all paths of another set.
    #[must_use]
    pub fn with(mut self, other: &TrustedPaths) -> TrustedPaths {
        self.paths.extend(other.paths.iter().cloned());
        self
    }

    /// Returns the paths, sorted.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.paths.iter().map(PathBuf::as_path)
    }

    /// Returns true if a file is one of these paths or below one, with links and `..` resolved.
    pub fn contains(&self, file: &Path) -> bool {
        canonical(file).is_ok_and(|file| self.is_above(&file))
    }

    fn is_above(&self, file: &Path) -> bool {
        self.paths.iter().any(|path| file.starts_with(path))
    }

    /// Checks that the file to which a file of this base refers as `written` may be opened, and returns its canonical path.
    ///
    /// # Errors
    /// [`Unread::Refused`], or the file cannot be reached.
    pub fn check(&self, base: &PathBase, written: &str) -> Result<PathBuf, Unread> {
        self.check_at(base, written, &base.resolve(written))
    }

    /// Reads a file to which a model of this base refers, and returns its bytes and its place.
    ///
    /// # Errors
    /// As those of [`TrustedPaths::find_of_model`], or the file cannot be read or has more than `limit` bytes.
    pub fn read_of_model(&self, base: &PathBase, written: &str, limit: u64) -> Result<(Vec<u8>, PathBuf), Unread> {
        let found = match self.find_of_model(base, written) {
            Err(Unread::Missing) => self.find_of_model_in_other_case(base, written),
            found => found,
        };
        let (file, place) = found?;
        Ok((read_plain(&file, limit)?, place))
    }

    /// Finds a file to which a model of this base refers, in the first of the possible places where a file exists. Returns
    /// its canonical path, and that place.
    ///
    /// # Errors
    /// See [`Unread`]. A file that may not be opened is an error only if no file exists in the other places, since models
    /// often contain paths of the computer on which they were made.
    pub fn find_of_model(&self, base: &PathBase, written: &str) -> Result<(PathBuf, PathBuf), Unread> {
        let mut refused = Unread::Missing;
        for (text, place) in base.places(written) {
            match self.check_at(base, &text, &place) {
                Ok(file) => return Ok((file, place)),
                Err(Unread::Missing) => {}
                Err(Unread::Refused(refusal)) if refused == Unread::Missing => refused = Unread::Refused(refusal),
                Err(Unread::Refused(_)) => {}
                Err(unread) => return Err(unread),
            }
        }
        Err(refused)
    }

    /// Finds a file whose name a model of this base writes with upper and lower case letters that differ from those on
    /// disk. The places in which it may be are searched in order, by listing their folders.
    ///
    /// # Errors
    /// As those of [`TrustedPaths::find_of_model`].
    pub fn find_of_model_in_other_case(&self, base: &PathBase, written: &str) -> Result<(PathBuf, PathBuf), Unread> {
        let mut places = base.places(written).into_iter();
        let found = places.find_map(|(text, _)| base.place_in_other_case(&text));
        let (text, place) = found.ok_or(Unread::Missing)?;
        Ok((self.check_at(base, &text, &place)?, place))
    }

    /// Reads a file that a file of this base names as `written`, if it may be opened, has at most `limit` bytes and is no pipe or
    /// device.
    ///
    /// # Errors
    /// See [`Unread`].
    pub fn read(&self, base: &PathBase, written: &str, limit: u64) -> Result<Vec<u8>, Unread> {
        read_plain(&self.check(base, written)?, limit)
    }

    /// Reads a file at a place that a file of this base implies but does not name, like [`TrustedPaths::read`].
    ///
    /// # Errors
    /// See [`Unread`].
    pub fn read_at(&self, base: &PathBase, place: &Path, limit: u64) -> Result<Vec<u8>, Unread> {
        read_plain(&self.check_place(base, place)?, limit)
    }

    /// Checks that a file or folder at a place that a file of this base implies may be opened, and returns its canonical path.
    ///
    /// # Errors
    /// [`Unread::Refused`], or it cannot be reached.
    pub fn check_place(&self, base: &PathBase, place: &Path) -> Result<PathBuf, Unread> {
        match self.check_found(place) {
            Err(Unread::Refused(Refusal::Outside { file })) if base.is_above(&file) => Ok(file),
            checked => checked,
        }
    }

    /// Checks that a file or folder that no file refers to may be opened, for example one found by listing a folder, and returns its
    /// canonical path. Only the trusted paths decide, not the folder in which it was found, since that may be a link itself.
    ///
    /// # Errors
    /// [`Unread::Refused`], or it cannot be reached.
    pub fn check_found(&self, place: &Path) -> Result<PathBuf, Unread> {
        let direct = without_detours(&absolute(place));
        if is_device(&direct) {
            let file = direct;
            return Err(Unread::Refused(Refusal::Device { file }));
        }
        let file = canonical(place).map_err(unread)?;
        if is_device(&file) {
            return Err(Unread::Refused(Refusal::Device { file }));
        }
        // Check this before trust: advice to trust a path would not help with a path that is not opened anyway.
        let kind = fs::metadata(&file).map_err(unread)?;
        if !kind.is_file() && !kind.is_dir() {
            return Err(Unread::Refused(Refusal::Device { file }));
        }
        match self.is_above(&file) {
            true => Ok(file),
            false => Err(Unread::Refused(Refusal::Outside { file })),
        }
    }

    /// Reads a file that no file refers to, if it may be opened, has at most `limit` bytes and is neither a pipe nor a device.
    ///
    /// # Errors
    /// See [`Unread`].
    pub fn read_found(&self, place: &Path, limit: u64) -> Result<Vec<u8>, Unread> {
        read_plain(&self.check_found(place)?, limit)
    }

    fn check_at(&self, base: &PathBase, written: &str, place: &Path) -> Result<PathBuf, Unread> {
        if leads_to_network(written) {
            let written = written.to_owned();
            return Err(Unread::Refused(Refusal::Network { written }));
        }
        if is_url(written) {
            let written = written.to_owned();
            return Err(Unread::Refused(Refusal::Url { written }));
        }
        self.check_place(base, place)
    }
}

impl PathBase {
    /// Returns true if a file is in the folder of the base or below it, with links and `..` resolved.
    pub fn is_above(&self, file: &Path) -> bool {
        match (canonical(self.folder()), canonical(file)) {
            (Ok(folder), Ok(file)) => file.starts_with(folder),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests;
