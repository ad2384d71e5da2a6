//! Names of entries that every system can hold, and tells apart.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::invisible::is_invisible;

/// Longest part of a name, in bytes: file systems allow 255 bytes or 255 units of 16 bits.
const LONGEST_PART: usize = 255;
/// Longest name, in bytes: with the folder before it, it has to be a path.
const LONGEST_NAME: usize = 1024;

/// Reason why an archive cannot have an entry of a name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NameFault {
    /// It is absolute, or leads up.
    #[error("its name leads out of the folder")]
    Outside,
    /// It is empty, or a part of it is.
    #[error("its name, or a part of it, is empty")]
    Empty,
    /// It has a character that Windows refuses.
    #[error("Windows has no names with the character {0:?}")]
    Character(char),
    /// It has a character that is not seen, or shows the name as another one.
    #[error("its name has the character U+{:04X}, which is not seen and may show it as another name", u32::from(*.0))]
    Invisible(char),
    /// It has the name of a device.
    #[error("'{0}' is the name of a device on Windows")]
    Device(String),
    /// A part ends in a dot or a space, which Windows drops.
    #[error("Windows has no names that end in a dot or a space")]
    End,
    /// It is too long.
    #[error("its name is too long")]
    Long,
    /// Another entry has the name, as far as every system can tell.
    #[error("'{0}' is in the archive as well, and many disks take both names for one")]
    Taken(String),
}

/// Names of the entries of one archive.
#[derive(Clone, Debug, Default)]
pub struct EntryNames {
    /// Names of files, by the form in which many disks compare them.
    files: BTreeMap<String, String>,
    /// Folders that these names bring along, likewise.
    folders: BTreeMap<String, String>,
}

impl EntryNames {
    /// Adds the name of a file, with `/` between folders.
    ///
    /// # Errors
    /// Some systems cannot hold it beside the others; nothing is added then.
    pub fn add(&mut self, name: &str) -> Result<(), NameFault> {
        check(name)?;
        let whole = folded(name);
        let folders: Vec<&str> = name.match_indices('/').map(|(at, _)| &name[..at]).collect();
        let of_folder = folders.iter().find_map(|folder| self.files.get(&folded(folder)));
        let other = self
            .files
            .get(&whole)
            .or_else(|| self.folders.get(&whole))
            .or(of_folder);
        if let Some(other) = other {
            return Err(NameFault::Taken(other.clone()));
        }
        for folder in folders {
            self.folders.insert(folded(folder), folder.to_owned());
        }
        self.files.insert(whole, name.to_owned());
        Ok(())
    }
}

/// Form of a name in which names are equal if disks that ignore case take them for one.
fn folded(name: &str) -> String {
    name.to_uppercase().to_lowercase()
}

/// Checks that a name is a plain path below a folder, on every system.
pub(super) fn check(name: &str) -> Result<(), NameFault> {
    if name.is_empty() {
        return Err(NameFault::Empty);
    }
    let has_drive = name.as_bytes().get(1) == Some(&b':');
    if name.starts_with(['/', '\\']) || has_drive || name.split(['/', '\\']).any(|part| part == "..") {
        return Err(NameFault::Outside);
    }
    if name.len() > LONGEST_NAME {
        return Err(NameFault::Long);
    }
    name.split('/').try_for_each(check_part)
}

fn check_part(part: &str) -> Result<(), NameFault> {
    if part.is_empty() || part == "." {
        return Err(NameFault::Empty);
    }
    if part.len() > LONGEST_PART {
        return Err(NameFault::Long);
    }
    if let Some(odd) = part.chars().find(|c| c.is_control() || "\\:*?\"<>|".contains(*c)) {
        return Err(NameFault::Character(odd));
    }
    if let Some(odd) = part.chars().find(|c| is_invisible(*c)) {
        return Err(NameFault::Invisible(odd));
    }
    if part.ends_with(['.', ' ']) {
        return Err(NameFault::End);
    }
    // Windows finds the device behind any ending, and behind spaces before it.
    let stem = part.split('.').next().unwrap_or(part).trim_end();
    if is_device(&stem.to_ascii_uppercase()) {
        return Err(NameFault::Device(part.to_owned()));
    }
    Ok(())
}

/// Devices of Windows, which are found in every folder.
fn is_device(stem: &str) -> bool {
    let numbered = stem.strip_prefix("COM").or_else(|| stem.strip_prefix("LPT"));
    let is_number = |rest: &str| {
        let mut chars = rest.chars();
        matches!((chars.next(), chars.next()), (Some('0'..='9' | '¹' | '²' | '³'), None))
    };
    matches!(stem, "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$") || numbered.is_some_and(is_number)
}
