//! Reasons why a file to which another file refers is not opened.

use std::fmt;
use std::path::{Path, PathBuf};

/// Reason why a file to which another file refers is not opened. The text is a clause that starts with the path.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Refusal {
    /// The file is outside of all folders that may be read.
    Outside {
        /// The file, with links resolved.
        file: PathBuf,
    },
    /// The file is on another computer.
    Network {
        /// The path as written.
        written: String,
    },
    /// The text is a URL and not a path.
    Url {
        /// The address as written.
        written: String,
    },
    /// The file is a device, a pipe, or a file whose content the system generates.
    Device {
        /// The path.
        file: PathBuf,
    },
}

impl Refusal {
    /// Returns the folder that has to be trusted so that the file can be read; `None` if trust does not help.
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
            Refusal::Device { file } => write!(f, "{} is a device or a pipe, which files never open", file.display()),
        }
    }
}

impl std::error::Error for Refusal {}
