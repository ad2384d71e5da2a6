//! A user's node folder: `<category>/<name>.wgsl` and `lib/<name>.wgsl`.

use std::fs::{self, DirEntry};
use std::io;
use std::path::{Path, PathBuf};

use sabi_files::{TrustedPaths, Unread};

use super::Library;
use crate::compile::check_library;
use crate::fault::Fault;
use crate::shader_files::shared_path;
use crate::source_file::{FILE_LIMIT_BYTES, SourceFile};

/// Maximum number of files and folders in a node folder, counting all its categories.
const FOLDER_LIMIT: usize = 4096;
/// Maximum total size of the files in a node folder, in bytes.
const TOTAL_LIMIT_BYTES: usize = 32 << 20;

impl Library {
    /// Reads a user's node folder in sorted order and returns the faults of files that are left out. Reading it again
    /// updates changed nodes, keeps the last valid version of faulty ones, and removes nodes whose file is gone.
    ///
    /// A node of the folder never replaces a node from another file. Nothing outside of the trusted paths is read: a folder
    /// from an unknown source may contain links to any file, and faults quote lines of the file.
    pub fn load_folder(&mut self, folder: &Path, trusted: &TrustedPaths) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.kinds
            .retain(|_, kind| !kind.path().starts_with(folder) || kind.path().exists());
        let mut reading = FolderReading::new(trusted);
        let categories = reading.entries(folder, false, &mut faults);
        for file in reading.wgsl_files(&folder.join("lib"), true, &mut faults) {
            if let Some((name, text)) = reading.read(&file, &mut faults) {
                self.add_library(&file, name, text, &mut faults);
            }
        }
        for entry in categories {
            let (path, category) = (entry.path(), entry.file_name());
            if category == "lib" || !path.is_dir() {
                continue;
            }
            for file in reading.wgsl_files(&path, false, &mut faults) {
                if let Some((name, text)) = reading.read(&file, &mut faults) {
                    let category = category.to_string_lossy();
                    self.add_node(format!("{category}/{name}"), file, text, &mut faults);
                }
            }
        }
        if reading.is_over {
            faults.push(Fault::of_file(
                folder,
                format!(
                    "The folder holds more than {FOLDER_LIMIT} files or {} MiB of nodes, and only some of them are read.",
                    TOTAL_LIMIT_BYTES >> 20
                ),
                "Name a folder that holds nodes only.",
            ));
        }
        faults
    }

    fn add_library(&mut self, path: &Path, name: String, text: String, faults: &mut Vec<Fault>) {
        if let Some(known) = self.libraries.text(&name) {
            if known == text {
                return;
            }
            if self.library_paths.get(&name).is_none_or(|known| known != path) {
                faults.push(Fault::of_file(
                    path,
                    format!("There is a library `{name}` already, and this one is not read."),
                    "Give the file another name.",
                ));
            } else if let Err(found) = self.replace_library(&name, text) {
                faults.extend(found.into_iter().map(|mut fault| {
                    if fault.path == shared_path(&name) {
                        fault.path = path.to_path_buf();
                    }
                    fault
                }));
            }
            return;
        }
        self.libraries.0.insert(name.clone(), text);
        if let Err(mut fault) = check_library(&name, &self.libraries) {
            fault.path = path.to_path_buf();
            faults.push(fault);
            self.libraries.0.remove(&name);
        } else {
            self.library_paths.insert(name, path.to_path_buf());
        }
    }

    fn add_node(&mut self, id: String, path: PathBuf, text: String, faults: &mut Vec<Fault>) {
        match self.kinds.get(&id) {
            Some(known) if known.path() != path => faults.push(Fault::of_file(
                &path,
                format!("There is a node `{id}` already, and this one is not read."),
                "Give the file another name.",
            )),
            // If only a library changed, its nodes were read again together with it.
            Some(known) if known.text() == text => {}
            _ => {
                if let Err(mut found) = self.replace(SourceFile { path, id, text }) {
                    faults.append(&mut found);
                }
            }
        }
    }
}

/// Lists the files that [`Library::load_folder`] would read from a node folder, as far as they may be opened.
pub fn files_of_folder(folder: &Path, trusted: &TrustedPaths) -> Vec<PathBuf> {
    let mut unread = Vec::new(); // Files that cannot be read are reported when the folder is loaded.
    let mut reading = FolderReading::new(trusted);
    let categories = reading.entries(folder, true, &mut unread).into_iter();
    let folders: Vec<PathBuf> = categories
        .map(|entry| entry.path())
        .filter(|path| path.is_dir())
        .collect();
    let files = folders
        .iter()
        .flat_map(|category| reading.wgsl_files(category, true, &mut unread));
    let mut files: Vec<PathBuf> = files.collect();
    files.retain(|file| trusted.check_found(file).is_ok());
    files
}

/// State while a node folder is read. The limits apply to all its categories together.
struct FolderReading<'t> {
    trusted: &'t TrustedPaths,
    /// Number of files and folders that may still be listed.
    left: usize,
    /// Number of bytes that may still be read.
    left_bytes: usize,
    /// True once something was left out because of a limit.
    is_over: bool,
}

impl FolderReading<'_> {
    fn new(trusted: &TrustedPaths) -> FolderReading<'_> {
        FolderReading {
            trusted,
            left: FOLDER_LIMIT,
            left_bytes: TOTAL_LIMIT_BYTES,
            is_over: false,
        }
    }

    /// Returns the entries of a folder, sorted by name.
    fn entries(&mut self, folder: &Path, may_be_missing: bool, faults: &mut Vec<Fault>) -> Vec<DirEntry> {
        match self.trusted.check_found(folder) {
            Ok(_) => {}
            Err(Unread::Missing) if may_be_missing => return Vec::new(),
            Err(unread) => {
                faults.push(unread_fault(folder, "folder", &unread));
                return Vec::new();
            }
        }
        let most = self.left;
        let listed =
            fs::read_dir(folder).and_then(|entries| entries.take(most + 1).collect::<io::Result<Vec<DirEntry>>>());
        match listed {
            Ok(mut entries) => {
                if entries.len() > most {
                    self.is_over = true;
                    entries.truncate(most);
                }
                self.left -= entries.len();
                entries.sort_by_key(DirEntry::file_name);
                entries
            }
            Err(error) => {
                faults.push(unread_fault(folder, "folder", &Unread::Other(error.to_string())));
                Vec::new()
            }
        }
    }

    /// The WGSL files of a folder, sorted by name.
    fn wgsl_files(&mut self, folder: &Path, may_be_missing: bool, faults: &mut Vec<Fault>) -> Vec<PathBuf> {
        let entries = self.entries(folder, may_be_missing, faults).into_iter();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.retain(|file| file.extension().is_some_and(|ending| ending == "wgsl") && !file.is_dir());
        files
    }

    /// Returns name and text of a file. Reports a fault if the file may not be opened, is too large or is not text.
    fn read(&mut self, file: &Path, faults: &mut Vec<Fault>) -> Option<(String, String)> {
        let name = file.file_stem()?.to_string_lossy().into_owned();
        if self.left_bytes == 0 {
            self.is_over = true;
            return None;
        }
        let bytes = match self.trusted.read_found(file, FILE_LIMIT_BYTES as u64) {
            Ok(bytes) => bytes,
            Err(unread) => {
                faults.push(unread_fault(file, "file", &unread));
                return None;
            }
        };
        self.left_bytes = self.left_bytes.saturating_sub(bytes.len());
        match String::from_utf8(bytes) {
            Ok(text) => Some((name, text)),
            Err(_) => {
                faults.push(Fault::of_file(file, "The file is not UTF-8 text.", "Save it as UTF-8."));
                None
            }
        }
    }
}

/// Returns the fault of a file or folder that is not read.
fn unread_fault(path: &Path, what: &str, unread: &Unread) -> Fault {
    let (message, advice) = match unread {
        Unread::Missing => (format!("The {what} cannot be read: it does not exist."), ""),
        Unread::Folder => (format!("The {what} cannot be read: it is a folder."), ""),
        Unread::NotPlain => (
            format!("The {what} is not read: it is a pipe or a device."),
            "Put a text file into its place.",
        ),
        Unread::TooLarge(_) => (
            format!("The {what} is larger than {} KiB.", FILE_LIMIT_BYTES / 1024),
            "Move tables into an image, and shared functions into a library.",
        ),
        Unread::Refused(refusal) => (
            format!("The {what} is not read, because {refusal}."),
            "Put the file itself into its place.",
        ),
        Unread::Other(why) => (format!("The {what} cannot be read: {why}."), ""),
    };
    Fault::of_file(path, message, advice)
}
