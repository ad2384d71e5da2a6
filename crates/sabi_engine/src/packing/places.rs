//! Places of files in an archive.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Component, Path, PathBuf};

use sabi_files::archive::{EntryNames, NameFault};
use sabi_files::is_invisible;

use super::entries::{check_file, check_name};
use super::manifest;
use super::model_files::ModelFiles;
use crate::error::{EngineError, ErrorKind};

/// Folder in an archive for files from outside of the graph's folder.
const OUTSIDE: &str = "files";
/// Maximum number of folders that are tried if a name is already used.
const MOST_FOLDERS: usize = 10_000;

/// Files of an archive with their names in it.
pub(super) struct Places {
    /// Folder of the graph.
    root: PathBuf,
    names: EntryNames,
    /// Name of each file, by its path.
    of: BTreeMap<PathBuf, String>,
    /// Files by name. A file may have two names, if a model refers to it by two paths.
    files: BTreeMap<String, PathBuf>,
}

impl Places {
    /// Places below the folder of a graph.
    pub(super) fn new(root: &Path) -> Result<Places, EngineError> {
        let mut names = EntryNames::default();
        names
            .add(manifest::NAME)
            .map_err(|fault| refused(manifest::NAME, fault))?;
        Ok(Places {
            root: root.to_owned(),
            names,
            of: BTreeMap::new(),
            files: BTreeMap::new(),
        })
    }

    /// Name of a file in the archive.
    pub(super) fn of(&self, path: &Path) -> Option<&str> {
        self.of.get(path).map(String::as_str)
    }

    /// Files by name.
    pub(super) fn files(&self) -> &BTreeMap<String, PathBuf> {
        &self.files
    }

    /// Returns true if a file is not below the graph's folder.
    pub(super) fn is_outside(&self, path: &Path) -> bool {
        !path.starts_with(&self.root)
    }

    /// Assigns a name to a file: its own path below the graph's folder, otherwise one in the folder for files from outside.
    /// The file name is kept as far as every system allows it.
    pub(super) fn take(&mut self, path: &Path) -> Result<(), EngineError> {
        if self.of.contains_key(path) {
            return Ok(());
        }
        if let Some(own) = self.below(path)
            && check_name(&own).is_ok()
            && self.names.add(&own).is_ok()
        {
            self.insert(path, own);
            return Ok(());
        }
        let name = plain_name(path);
        for number in 1..MOST_FOLDERS {
            let free = format!("{}/{name}", outside(number));
            if self.names.add(&free).is_ok() {
                self.insert(path, free);
                return Ok(());
            }
        }
        Err(EngineError::new(
            ErrorKind::BadInput,
            format!("{} finds no place in the archive; rename it", path.display()),
        ))
    }

    /// Assigns exactly this name to a file.
    pub(super) fn take_as(&mut self, path: &Path, name: &str) -> Result<(), EngineError> {
        if self.files.get(name).is_some_and(|known| known == path) {
            return Ok(());
        }
        let shown = path.display().to_string();
        check_name(name).map_err(|why| refused(&shown, why))?;
        self.names.add(name).map_err(|fault| refused(&shown, fault))?;
        self.insert(path, name.to_owned());
        Ok(())
    }

    /// Checks that all files are such as a bake reads.
    ///
    /// # Errors
    /// A sentence for each that is not, and would not be unpacked.
    pub(super) fn check_files(&self) -> Result<(), EngineError> {
        let fault = |(name, path): (&String, &PathBuf)| {
            let why = check_file(name, path).err()?;
            Some(format!("{} cannot be packed: {why}", path.display()))
        };
        // Missing files are reported elsewhere.
        let faults: Vec<String> = self
            .files
            .iter()
            .filter(|(_, path)| path.exists())
            .filter_map(fault)
            .collect();
        match faults.is_empty() {
            true => Ok(()),
            false => Err(EngineError::several(ErrorKind::BadInput, faults)),
        }
    }

    /// Assigns names to a model and the files that it names. Their relative positions are kept, since the model is not changed.
    pub(super) fn take_model(&mut self, model: &ModelFiles) -> Result<String, EngineError> {
        let own = self.below(&model.path).and_then(|own| {
            own.rsplit_once('/')
                .map(|(folder, _)| folder.to_owned())
                .or(Some(String::new()))
        });
        let depth = |folder: &str| folder.split('/').filter(|part| !part.is_empty()).count();
        let own = own.filter(|folder| depth(folder) >= model.levels_up());
        let fresh = (1..MOST_FOLDERS).map(|number| {
            // As many folders as the model's paths lead up, so that all stay inside of the archive.
            let below = "/model".repeat(model.levels_up());
            match model.is_alone() {
                true => outside(number),
                false => format!("{}/{}{below}", outside(number), stem(&model.path)),
            }
        });
        let (mut last, mut hidden) = (None, None);
        for folder in own.into_iter().chain(fresh) {
            let mut names = self.names.clone();
            let placed = model.placed_in(&folder);
            if let Some(why) = placed.iter().find_map(|(_, name)| check_name(name).err()) {
                hidden = Some(why);
                continue;
            }
            match placed.iter().try_for_each(|(_, name)| names.add(name)) {
                Ok(()) => {
                    self.names = names;
                    for (path, name) in &placed {
                        self.insert(path, name.clone());
                    }
                    return Ok(placed[0].1.clone());
                }
                Err(NameFault::Taken(other)) => last = Some(NameFault::Taken(other)),
                Err(fault) => return Err(refused(&model.path.display().to_string(), fault)),
            }
        }
        let shown = model.path.display().to_string();
        match (last, hidden) {
            (None, Some(why)) => Err(refused(
                &shown,
                format!("it names a file whose name has no place: {why}"),
            )),
            (last, _) => Err(refused(&shown, last.unwrap_or(NameFault::Long))),
        }
    }

    fn insert(&mut self, path: &Path, name: String) {
        self.of.entry(path.to_owned()).or_insert_with(|| name.clone());
        self.files.insert(name, path.to_owned());
    }

    /// Returns the path from the graph's folder, with `/` between folders; `None` outside of it, or for a name that is not Unicode.
    fn below(&self, path: &Path) -> Option<String> {
        let parts = path.strip_prefix(&self.root).ok()?.components().map(|part| match part {
            Component::Normal(name) => name.to_str(),
            _ => None,
        });
        parts.collect::<Option<Vec<&str>>>().map(|parts| parts.join("/"))
    }
}

/// Returns a folder for files from outside. If a name is already used in one, the next one is tried.
fn outside(number: usize) -> String {
    match number {
        1 => OUTSIDE.to_owned(),
        number => format!("{OUTSIDE}/{number}"),
    }
}

fn refused(shown: &str, fault: impl fmt::Display) -> EngineError {
    EngineError::new(
        ErrorKind::BadInput,
        format!("{shown} cannot be packed: {fault}; rename it"),
    )
}

/// Returns the name of a file, with `_` in place of characters that some systems refuse.
fn plain_name(path: &Path) -> String {
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let is_plain = |c: char| !is_invisible(c) && !"\\/:*?\"<>|\u{fffd}".contains(c);
    let plain: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    // A dot before a name hides it.
    let plain = plain.trim_end_matches(['.', ' ']).trim_start_matches('.');
    match EntryNames::default().add(plain) {
        Ok(()) => plain.to_owned(),
        // The name is that of a device, or empty.
        Err(_) => format!("file_{plain}"),
    }
}

fn stem(path: &Path) -> String {
    let name = plain_name(path);
    name.rsplit_once('.').map_or(name.clone(), |(stem, _)| stem.to_owned())
}
