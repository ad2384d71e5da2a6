//! Names of entries that are valid and distinct on every system.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::invisible::is_invisible;

/// Maximum length of a part of a name, in bytes: file systems allow 255 bytes, or 255 units of 16 bits.
const LONGEST_PART: usize = 255;
/// Maximum length of a name, in bytes: together with a folder it must form a valid path.
const LONGEST_NAME: usize = 1024;

/// Reason why an archive cannot have an entry with a certain name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NameFault {
    /// The name is absolute, or leads out of the folder.
    #[error("its name leads out of the folder")]
    Outside,
    /// The name or a part of it is empty.
    #[error("its name, or a part of it, is empty")]
    Empty,
    /// The name has a character that Windows refuses.
    #[error("Windows has no names with the character {0:?}")]
    Character(char),
    /// The name has a character that is invisible or changes how the name is displayed.
    #[error("its name has the character U+{:04X}, which is not seen and may show it as another name", u32::from(*.0))]
    Invisible(char),
    /// The name is the name of a device.
    #[error("'{0}' is the name of a device on Windows")]
    Device(String),
    /// A part ends in a dot or a space, which Windows drops.
    #[error("Windows has no names that end in a dot or a space")]
    End,
    /// The name is too long.
    #[error("its name is too long")]
    Long,
    /// Another entry has the same name on some systems.
    #[error("'{0}' is in the archive as well, and many disks take both names for one")]
    Taken(String),
}

/// Names of the entries of one archive.
#[derive(Clone, Debug, Default)]
pub struct EntryNames {
    /// Names of files, by the form in which many file systems compare them.
    files: BTreeMap<String, String>,
    /// Folders of these files, by the same form.
    folders: BTreeMap<String, String>,
}

impl EntryNames {
    /// Adds the name of a file, with `/` between folders.
    ///
    /// # Errors
    /// The name is not valid or not distinct on some systems. It is not added.
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

/// Returns a form of a name that is equal for names that file systems which ignore case treat as the same.
fn folded(name: &str) -> String {
    name.to_uppercase().to_lowercase()
}

/// Checks that a name is a plain relative path inside a folder, on every system.
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
    // Windows recognizes a device name with any extension, and with spaces before the extension.
    let stem = part.split('.').next().unwrap_or(part).trim_end();
    if is_device(&stem.to_ascii_uppercase()) {
        return Err(NameFault::Device(part.to_owned()));
    }
    Ok(())
}

/// Returns true for a device of Windows, which exists in every folder.
fn is_device(stem: &str) -> bool {
    let numbered = stem.strip_prefix("COM").or_else(|| stem.strip_prefix("LPT"));
    let is_number = |rest: &str| {
        let mut chars = rest.chars();
        matches!((chars.next(), chars.next()), (Some('0'..='9' | '¹' | '²' | '³'), None))
    };
    matches!(stem, "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$") || numbered.is_some_and(is_number)
}
