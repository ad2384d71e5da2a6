//! The library of kinds: built-in kinds, and kinds from a user's folder, which are read again when they change.

mod entry;
mod folder;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use self::entry::{BuiltIn, KindEntry};
pub use self::folder::files_of_folder;
use crate::compile::check_library;
use crate::fault::Fault;
use crate::kind::Kind;
use crate::reader::read_kind;
use crate::shader_files::{CORE, Libraries, node_files};
use crate::source_file::SourceFile;
use crate::words::nearest;

/// Node kinds by id, and the libraries they use.
#[derive(Clone, Debug, Default)]
pub struct Library {
    kinds: BTreeMap<String, KindEntry>,
    libraries: Libraries,
    /// Paths of the libraries that come from folders, to distinguish a changed file from a second file with the same name.
    library_paths: BTreeMap<String, PathBuf>,
}

impl Library {
    /// Reads all of these files at once, for tests and tools. Faulty ones are left out, and their faults are returned.
    pub fn load(files: Vec<SourceFile>, libraries: Libraries) -> (Library, Vec<Fault>) {
        let mut faults = Vec::new();
        let mut library = Library {
            kinds: BTreeMap::new(),
            libraries,
            library_paths: BTreeMap::new(),
        };
        library.drop_faulty_libraries(&mut faults);
        for file in files {
            if let Err(mut found) = library.replace(file) {
                faults.append(&mut found);
            }
        }
        (library, faults)
    }

    /// Returns the built-in kinds. Each is read once in a process, when it is first needed. A test checks that they have no faults.
    pub fn builtin() -> Library {
        let kinds = BuiltIn::all().iter();
        Library {
            kinds: kinds
                .map(|kind| (kind.id.to_owned(), KindEntry::BuiltIn(kind)))
                .collect(),
            libraries: Libraries::builtin().clone(),
            library_paths: BTreeMap::new(),
        }
    }

    /// Returns the texts of the built-in kinds and of their libraries.
    pub fn builtin_files() -> (Vec<SourceFile>, Libraries) {
        let files = node_files().map(|(path, id, text)| SourceFile {
            path,
            id: id.to_owned(),
            text: text.to_owned(),
        });
        (files.collect(), Libraries::builtin().clone())
    }

    /// Returns the kind with this current or earlier (`@was`) id.
    pub fn kind(&self, id: &str) -> Option<&Kind> {
        let present = self.kinds.get(id).and_then(KindEntry::kind);
        present.or_else(|| self.kinds.values().find_map(|entry| entry.formerly(id)))
    }

    /// All kinds, sorted by id.
    pub fn kinds(&self) -> impl Iterator<Item = &Kind> {
        self.kinds.values().filter_map(KindEntry::kind)
    }

    /// The libraries that kinds use.
    pub fn libraries(&self) -> &Libraries {
        &self.libraries
    }

    /// Returns the file of a library from a user's folder; `None` for a built-in library.
    pub fn library_path(&self, name: &str) -> Option<&Path> {
        self.library_paths.get(name).map(PathBuf::as_path)
    }

    /// Returns the existing id nearest to an unknown one, for "did you mean".
    pub fn nearest(&self, id: &str) -> Option<&str> {
        let known = || self.kinds.keys().map(String::as_str);
        nearest(id, known()).or_else(|| {
            // Both `simplex` and `noises/simplex` match the kind with that name.
            let name = id.rsplit('/').next()?;
            known().find(|known| known.rsplit('/').next() == Some(name))
        })
    }

    /// Reads a new or changed file. If the file is faulty, nothing changes: the last valid version stays.
    pub fn replace(&mut self, file: SourceFile) -> Result<(), Vec<Fault>> {
        let kind = read_kind(&file, &self.libraries)?;
        self.insert(kind);
        Ok(())
    }

    /// Takes a new or changed text of a library and reads the kinds that use it again. If one of them becomes faulty, nothing changes.
    pub fn replace_library(&mut self, name: &str, text: String) -> Result<(), Vec<Fault>> {
        let mut libraries = self.libraries.clone();
        libraries.0.insert(name.to_owned(), text);
        check_library(name, &libraries).map_err(|fault| vec![fault])?;
        let users = self
            .kinds()
            .filter(|kind| name == CORE || kind.libraries.iter().any(|used| used == name));
        let mut changed = Vec::new();
        let mut faults = Vec::new();
        for kind in users {
            let file = SourceFile {
                path: kind.path.clone(),
                id: kind.id.clone(),
                text: kind.source.to_string(),
            };
            match read_kind(&file, &libraries) {
                Ok(kind) => changed.push(kind),
                Err(mut found) => faults.append(&mut found),
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        self.libraries = libraries;
        changed.into_iter().for_each(|kind| self.insert(kind));
        Ok(())
    }

    fn insert(&mut self, kind: Kind) {
        self.kinds.insert(kind.id.clone(), KindEntry::Read(Arc::new(kind)));
    }

    /// Removes the kinds of a folder that no longer exists.
    pub fn remove_folder(&mut self, folder: &Path) {
        self.kinds.retain(|_, kind| !kind.path().starts_with(folder));
    }

    /// Removes libraries that do not compile, so that each is reported once and not again by every node that uses it.
    fn drop_faulty_libraries(&mut self, faults: &mut Vec<Fault>) {
        let checked: Vec<(String, Fault)> = self
            .libraries
            .names()
            .filter_map(|name| Some((name.to_owned(), check_library(name, &self.libraries).err()?)))
            .collect();
        for (name, fault) in checked {
            self.libraries.0.remove(&name);
            if !faults.contains(&fault) {
                faults.push(fault);
            }
        }
    }
}
