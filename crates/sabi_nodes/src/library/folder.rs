//! A user's node folder: `<category>/<name>.wgsl` and `lib/<name>.wgsl`.

use std::fs::{self, DirEntry};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::Library;
use crate::compile::check_library;
use crate::fault::Fault;
use crate::shader_files::shared_path;
use crate::source_file::{FILE_LIMIT_BYTES, SourceFile};

/// Most files read from one folder.
const FOLDER_LIMIT: usize = 4096;

impl Library {
    /// Reads a user's node folder, in sorted order, and gives the faults of the files that are left out. Reading it again
    /// updates changed nodes, keeps the last good version of faulty ones, and drops nodes without a file.
    ///
    /// A node of the folder never replaces one from another file.
    pub fn load_folder(&mut self, folder: &Path) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.kinds
            .retain(|_, kind| !kind.path().starts_with(folder) || kind.path().exists());
        for file in wgsl_files(&folder.join("lib"), true, &mut faults) {
            if let Some((name, text)) = read(&file, &mut faults) {
                self.add_library(&file, name, text, &mut faults);
            }
        }
        for entry in entries(folder, false, &mut faults) {
            let (path, category) = (entry.path(), entry.file_name());
            if !path.is_dir() || category == "lib" {
                continue;
            }
            for file in wgsl_files(&path, false, &mut faults) {
                if let Some((name, text)) = read(&file, &mut faults) {
                    let category = category.to_string_lossy();
                    self.add_node(format!("{category}/{name}"), file, text, &mut faults);
                }
            }
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
            // The nodes of a changed library were read again with it.
            Some(known) if known.text() == text => {}
            _ => {
                if let Err(mut found) = self.replace(SourceFile { path, id, text }) {
                    faults.append(&mut found);
                }
            }
        }
    }
}

/// Entries of a folder, sorted by name.
fn entries(folder: &Path, may_be_missing: bool, faults: &mut Vec<Fault>) -> Vec<DirEntry> {
    let listed =
        fs::read_dir(folder).and_then(|entries| entries.take(FOLDER_LIMIT + 1).collect::<io::Result<Vec<DirEntry>>>());
    match listed {
        Ok(mut entries) => {
            if entries.len() > FOLDER_LIMIT {
                faults.push(Fault::of_file(
                    folder,
                    format!("The folder holds more than {FOLDER_LIMIT} files, and only some of them are read."),
                    "Name a folder that holds nodes only.",
                ));
                entries.truncate(FOLDER_LIMIT);
            }
            entries.sort_by_key(DirEntry::file_name);
            entries
        }
        Err(error) if may_be_missing && error.kind() == io::ErrorKind::NotFound => Vec::new(),
        Err(error) => {
            faults.push(Fault::of_file(
                folder,
                format!("The folder cannot be read: {error}."),
                "",
            ));
            Vec::new()
        }
    }
}

/// The WGSL files of a folder, sorted by name.
fn wgsl_files(folder: &Path, may_be_missing: bool, faults: &mut Vec<Fault>) -> Vec<PathBuf> {
    let entries = entries(folder, may_be_missing, faults).into_iter();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "wgsl") && file.is_file());
    files
}

/// Name and text of a file, unless it is too large or not text.
fn read(file: &Path, faults: &mut Vec<Fault>) -> Option<(String, String)> {
    let name = file.file_stem()?.to_string_lossy().into_owned();
    let mut bytes = Vec::new();
    let read = fs::File::open(file).and_then(|opened| opened.take(FILE_LIMIT_BYTES as u64 + 1).read_to_end(&mut bytes));
    if let Err(error) = read {
        faults.push(Fault::of_file(file, format!("The file cannot be read: {error}."), ""));
        return None;
    }
    // One byte over the limit lets the reader refuse the file by its size.
    match String::from_utf8(bytes) {
        Ok(text) => Some((name, text)),
        Err(error) if error.as_bytes().len() > FILE_LIMIT_BYTES => {
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            Some((name, text))
        }
        Err(_) => {
            faults.push(Fault::of_file(file, "The file is not UTF-8 text.", "Save it as UTF-8."));
            None
        }
    }
}
