//! Decision whether a file that another file names may be opened.
//!
//! A graph or a model may come from anywhere, and what it names is shown, baked and copied. So it reaches the files below its own
//! folder, and below the files and folders that the user named; everything else is refused with a sentence. Links and `..` are
//! resolved before the decision. Addresses of the network and devices are refused wherever they are.

mod address;
mod project;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fmt};

use self::address::{device, is_device, is_url, leads_to_network};
use self::project::project_of;
use crate::named::PathBase;
use crate::paths::{absolute, canonical};
use crate::read::{Unread, read_plain, unread};

/// Files and folders whose content may be opened by any file that names it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TrustedPaths {
    /// Canonical paths. A folder stands for all below it.
    paths: BTreeSet<PathBuf>,
}

/// Reason why a file that another one names is not opened. Its text is a clause that begins with the path.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Refusal {
    /// It is outside of all folders that may be read from.
    Outside {
        /// The file, with links resolved.
        file: PathBuf,
    },
    /// It is on another computer.
    Network {
        /// The path as it is written.
        written: String,
    },
    /// It is an address and no path.
    Url {
        /// The address as it is written.
        written: String,
    },
    /// It is a device, or a file that the system makes up.
    Device {
        /// The path.
        file: PathBuf,
    },
}

impl Refusal {
    /// Folder that makes the file readable when it is trusted; `None` where nothing does.
    pub fn folder(&self) -> Option<&Path> {
        match self {
            Refusal::Outside { file } => file.parent(),
            Refusal::Network { .. } | Refusal::Url { .. } | Refusal::Device { .. } => None,
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Outside { file } => write!(
                f,
                "{} is outside of the folder of the file that names it and of the folders that you trust",
                file.display()
            ),
            Refusal::Network { written } => write!(
                f,
                "{written} is on another computer, and files never open such paths; copy it beside the file that names it"
            ),
            Refusal::Url { written } => write!(
                f,
                "{written} is an address, and addresses are not fetched; copy the file beside the one that names it"
            ),
            Refusal::Device { file } => write!(f, "{} is a device, which files never open", file.display()),
        }
    }
}

impl std::error::Error for Refusal {}

impl TrustedPaths {
    /// Creates the paths that a file brings which the user names, such as a graph on the command line.
    pub fn of_file(file: &Path) -> TrustedPaths {
        TrustedPaths::default().with_file(file)
    }

    /// Adds the folder of a file that the user names, and the project that it belongs to: the nearest folder above with `.git` or
    /// `sabi.toml`. The home folder, and what is above it, is no project.
    #[must_use]
    pub fn with_file(mut self, file: &Path) -> TrustedPaths {
        // A path without a folder is relative to the current one.
        if let Ok(folder) = canonical(file.parent().unwrap_or(Path::new(""))) {
            self.paths
                .extend(project_of(&folder, env::home_dir().as_deref()).map(Path::to_owned));
            self.paths.insert(folder);
        }
        self
    }

    /// Adds a file or folder that the user trusts; one that does not exist adds nothing.
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

    /// The paths, sorted.
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

    /// Checks that a file which a file of this base names as `written` may be opened, and returns its canonical path.
    ///
    /// # Errors
    /// [`Unread::Refused`], or the file cannot be reached.
    pub fn check(&self, base: &PathBase, written: &str) -> Result<PathBuf, Unread> {
        self.check_at(base, written, &base.resolve(written))
    }

    /// Reads a file that a model of this base names, and returns it with its place.
    ///
    /// # Errors
    /// As those of [`TrustedPaths::find_of_model`], or the file cannot be read or has more than `limit` bytes.
    pub fn read_of_model(&self, base: &PathBase, written: &str, limit: u64) -> Result<(Vec<u8>, PathBuf), Unread> {
        let (file, place) = self.find_of_model(base, written)?;
        Ok((read_plain(&file, limit)?, place))
    }

    /// Finds a file that a model of this base names in the first of its places where there is one. Returns its canonical path, and
    /// that place.
    ///
    /// # Errors
    /// See [`Unread`]. A file that may not be opened is told only if there is none in the other places: models carry the paths of
    /// the computer they were made on.
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

    /// Reads a file that a file of this base names as `written`, if it may be opened, has at most `limit` bytes and is no pipe or
    /// device.
    ///
    /// # Errors
    /// See [`Unread`].
    pub fn read(&self, base: &PathBase, written: &str, limit: u64) -> Result<Vec<u8>, Unread> {
        read_plain(&self.check(base, written)?, limit)
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
        if let Some(file) = device(&absolute(place)) {
            return Err(Unread::Refused(Refusal::Device { file }));
        }
        let file = canonical(place).map_err(unread)?;
        if is_device(&file) {
            return Err(Unread::Refused(Refusal::Device { file }));
        }
        match base.is_above(&file) || self.is_above(&file) {
            true => Ok(file),
            false => Err(Unread::Refused(Refusal::Outside { file })),
        }
    }
}

/// Returns true if a text that names a file can be looked up: it is no address of the network, where even looking for a file sends
/// the name of the user.
pub fn is_local(written: &str) -> bool {
    !leads_to_network(written) && !is_url(written)
}

impl PathBase {
    /// Returns true if a file is in the folder of the base or below, with links and `..` resolved.
    pub fn is_above(&self, file: &Path) -> bool {
        match (canonical(self.folder()), canonical(file)) {
            (Ok(folder), Ok(file)) => file.starts_with(folder),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests;
