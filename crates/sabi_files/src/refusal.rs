//! Reasons why a file that another one names is not opened.

use std::fmt;
use std::path::{Path, PathBuf};

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
    /// It is a device, a pipe, or a file that the system makes up.
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
            Refusal::Device { file } => write!(f, "{} is a device or a pipe, which files never open", file.display()),
        }
    }
}

impl std::error::Error for Refusal {}
