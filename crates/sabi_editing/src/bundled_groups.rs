//! Graph files of the library with the group files that they use, as one document.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use sabi_engine::OpenGraph;
use sabi_files::canonical;
use sabi_graph::{Document, GROUP_KIND, GroupDef};

use crate::names::free_name;
use crate::open_document::OpenDocument;
use crate::{instances, relative_paths};

/// Maximum depth of files that use other files.
const DEEPEST: usize = 32;

/// Returns a graph file of the library with the groups of all files that it uses, as one document. Its paths are relative to `document`.
///
/// # Errors
/// A sentence about the first file that cannot be used.
pub(crate) fn bundled(document: &OpenDocument, open: &OpenGraph, file: &Path) -> Result<Document, String> {
    let mut bundle = Bundle {
        document,
        groups: BTreeMap::new(),
        files: BTreeMap::new(),
    };
    let mut bundled = bundle.with_inner_groups(open, &[canonical(file).unwrap_or_else(|_| file.to_owned())])?;
    bundled.groups = bundle.groups;
    Ok(bundled)
}

struct Bundle<'d> {
    document: &'d OpenDocument,
    groups: BTreeMap<String, GroupDef>,
    /// Name of the group made from each file that was read.
    files: BTreeMap<PathBuf, String>,
}

impl Bundle<'_> {
    /// Returns a graph whose instances refer to groups of the bundle, and adds its own groups and files to the bundle.
    /// `within` lists the files through which it was reached, outermost first.
    fn with_inner_groups(&mut self, open: &OpenGraph, within: &[PathBuf]) -> Result<Document, String> {
        let other = relative_paths::relocated(self.document, &open.document, open.folder());
        let mut names = BTreeMap::new();
        for name in other.groups.keys() {
            let taken = |name: &str| self.groups.contains_key(name) || names.values().any(|known| known == name);
            names.insert(name.clone(), free_name(name, ' ', taken));
        }
        for (_, graph) in instances::bodies(&other) {
            let used = graph.nodes().filter(|(_, node)| node.kind == GROUP_KIND);
            for named in used.filter_map(|(_, node)| node.group.clone()) {
                if let Entry::Vacant(free) = names.entry(named) {
                    let group = self.add_file(free.key(), within)?;
                    free.insert(group);
                }
            }
        }
        let mut renamed = other.with_group_names(|name| names.get(name).cloned());
        for (name, group) in std::mem::take(&mut renamed.groups) {
            // Every group of the graph has a name in the bundle.
            let name = names.get(&name).cloned().unwrap_or(name);
            self.groups.insert(name, group);
        }
        Ok(renamed)
    }

    /// Adds the graph of a file under a name that is free in the document, and returns the name of its group.
    fn add_file(&mut self, named: &str, within: &[PathBuf]) -> Result<String, String> {
        let path = self.document.session.graph().folder().join(named);
        let path = canonical(&path).unwrap_or(path);
        if let Some(known) = self.files.get(&path) {
            return Ok(known.clone());
        }
        if within.contains(&path) || within.len() == DEEPEST {
            return Err(format!(
                "{} uses itself as a group; take that instance out",
                path.display()
            ));
        }
        let graph = self.document.session.graph();
        let open = graph.open_group(named).map_err(|error| error.to_string())?;
        let within: Vec<PathBuf> = within.iter().cloned().chain([path.clone()]).collect();
        let inner = self.with_inner_groups(&open, &within)?;
        let stem = group_name(&inner, &path);
        let name = free_name(&stem, ' ', |name| self.groups.contains_key(name));
        self.groups.insert(name.clone(), as_group(&inner));
        self.files.insert(path, name.clone());
        Ok(name)
    }
}

/// Returns the name that a library file's group gets in a document.
pub(crate) fn group_name(library: &Document, file: &Path) -> String {
    if library.name.is_empty() {
        let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        return stem.unwrap_or_else(|| "Group".to_owned());
    }
    library.name.clone()
}

/// Converts the graph of a document to a group of another document.
pub(crate) fn as_group(document: &Document) -> GroupDef {
    GroupDef {
        name: None,
        description: document.description.clone(),
        fit: Some(document.fit),
        graph: document.graph.clone(),
        inputs: document.inputs.clone(),
        outputs: document.outputs.clone(),
        ..GroupDef::default()
    }
}
