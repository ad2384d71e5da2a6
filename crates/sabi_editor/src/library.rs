//! The library: groups in files of their own, which every graph can use.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_editing::OpenDocument;
use sabi_editing::library::GRAPH_EXTENSION;
use sabi_editing::linked_groups::file_of;
use sabi_engine::OpenGraph;
use sabi_engine::catalog::{Catalog, Interfaces};
use sabi_engine::effect_library::group_digest;
use sabi_files::TrustedPaths;

use sabi_graph::LibrarySource;

use crate::action::LibraryKind;
use crate::paths::file_stem;
use crate::search::LibraryGroup;

/// Groups in the folders of the library, read again when a file changes.
#[derive(Default)]
pub(crate) struct GroupLibrary {
    /// True if files may have changed since they were read.
    is_stale: bool,
    groups: Vec<LibraryGroup>,
    /// Sentences about files that cannot be used.
    faults: Vec<String>,
    /// Folders and files that were read.
    files: Arc<[PathBuf]>,
    /// Folders that were read.
    folders: Option<Vec<(LibraryKind, PathBuf)>>,
}

impl GroupLibrary {
    /// Marks the files to be read again, since they may have changed.
    pub(crate) fn invalidate(&mut self) {
        self.is_stale = true;
    }

    /// Folders and files that were read.
    pub(crate) fn files(&self) -> &Arc<[PathBuf]> {
        &self.files
    }

    /// Sentences about files that cannot be used.
    pub(crate) fn faults(&self) -> &[String] {
        &self.faults
    }

    /// Returns whether these folders have to be read.
    pub(crate) fn has_changed(&self, folders: &[(LibraryKind, PathBuf)]) -> bool {
        self.is_stale || self.folders.as_deref() != Some(folders)
    }

    /// Digest of the file that a link of a document leads to; `None` if it is in none of the folders.
    pub(crate) fn digest(&self, document: &OpenDocument, source: &LibrarySource) -> Option<&str> {
        self.group(&file_of(document, source)?)?.digest.as_deref()
    }

    /// Group in a file, if it is in one of the folders.
    pub(crate) fn group(&self, file: &Path) -> Option<&LibraryGroup> {
        self.groups.iter().find(|group| group.file == file)
    }

    /// Groups in these folders, which are read if they have to be.
    pub(crate) fn groups(&mut self, folders: Vec<(LibraryKind, PathBuf)>, catalog: &Catalog) -> &[LibraryGroup] {
        if self.has_changed(&folders) {
            self.is_stale = false;
            self.groups.clear();
            self.faults.clear();
            let mut files = Vec::new();
            for (library, folder) in &folders {
                files.push(folder.clone());
                files.extend(self.read(*library, folder, folder, None, catalog));
            }
            self.files = files.into();
            self.folders = Some(folders);
        }
        &self.groups
    }

    /// Adds the groups of a folder, and of the folders in it, which are categories. Returns their graph files.
    fn read(
        &mut self,
        library: LibraryKind,
        root: &Path,
        folder: &Path,
        category: Option<&str>,
        catalog: &Catalog,
    ) -> Vec<PathBuf> {
        let entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) => {
                if error.kind() != ErrorKind::NotFound {
                    self.faults
                        .push(format!("{} cannot be read: {error}", folder.display()));
                }
                return Vec::new();
            }
        };
        let mut entries: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        entries.sort();
        let (folders, mut files): (Vec<PathBuf>, Vec<PathBuf>) = entries.into_iter().partition(|entry| entry.is_dir());
        files.retain(|file| file.extension().is_some_and(|ending| ending == GRAPH_EXTENSION));
        for file in &files {
            match group_of(library, root, file, catalog) {
                Ok(group) => self.groups.push(LibraryGroup {
                    category: category.map(str::to_owned),
                    ..group
                }),
                Err(why) => self.faults.push(why),
            }
        }
        if category.is_none() {
            for inner in folders {
                let name = inner.file_name().map(|name| name.to_string_lossy().into_owned());
                files.extend(self.read(library, root, &inner, name.as_deref(), catalog));
            }
        }
        files
    }
}

/// A file of the library at a root as a group that other graphs can use, or a sentence about why it is none.
fn group_of(library: LibraryKind, root: &Path, file: &Path, catalog: &Catalog) -> Result<LibraryGroup, String> {
    let trusted = TrustedPaths::default().with_path(root);
    let open = OpenGraph::open_trusting(file, &trusted).map_err(|error| error.to_string())?;
    let mut beside = |name: &str| Some(open.open_group(name).ok()?.document);
    let interfaces = Interfaces::new(catalog, &open.document, &mut beside);
    let whole = interfaces.of_whole().ok_or_else(|| {
        let why = "is in the library, and gives nothing that other graphs could use; add an output to it";
        format!("{} {why}", file.display())
    })?;
    let mut interface = whole.as_ref().clone();
    if interface.label == "Group" {
        interface.label = file_stem(file).into_owned();
    }
    Ok(LibraryGroup {
        library,
        category: None,
        digest: group_digest(&open).ok(),
        file: file.to_owned(),
        graph: Arc::new(open),
        interface: Arc::new(interface),
    })
}
