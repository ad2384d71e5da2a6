//! Node files that the artist wrote and a graph uses.

use std::collections::BTreeMap;
use std::path::PathBuf;

use sabi_graph::{GROUP_KIND, REROUTE_KIND};

use super::named_files::NamedDocument;
use crate::opening::kinds::Kinds;

/// Node files by their names in the archive, and sentences about nodes whose files are missing.
pub(crate) fn own_nodes(
    kinds: &Kinds,
    folders: &[PathBuf],
    documents: &[NamedDocument],
) -> (BTreeMap<String, PathBuf>, Vec<String>) {
    let (mut files, mut missing) = (BTreeMap::new(), Vec::new());
    for (words, node) in documents.iter().flat_map(NamedDocument::nodes) {
        let id = node.kind.split_once('@').map_or(node.kind.as_str(), |(plain, _)| plain);
        let is_special = matches!(id, GROUP_KIND | REROUTE_KIND);
        if is_special || kinds.sources.contains_key(id) || kinds.sinks.contains_key(id) {
            continue;
        }
        let Some(kind) = kinds.library.kind(id) else {
            missing.push(format!(
                "{words} is of a kind whose node file is missing or has a fault"
            ));
            continue;
        };
        // The others come with the program.
        if folders.iter().any(|folder| kind.path.starts_with(folder)) {
            files.insert(format!("nodes/{}.wgsl", kind.id), kind.path.clone());
        }
        for library in &kind.libraries {
            if let Some(path) = kinds.library.library_path(library) {
                files.insert(format!("nodes/lib/{library}.wgsl"), path.to_owned());
            }
        }
    }
    (files, missing)
}
