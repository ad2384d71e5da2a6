//! The effect library: groups in graph files. Release builds contain the files, and debug builds read them from the project.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sabi_graph::{Document, GROUP_KIND, Graph};
use sabi_view::Pixels;

use crate::catalog::first_square;
use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
#[cfg(library_included)]
use sabi_files::write_whole;

#[cfg(library_included)]
include!(concat!(env!("OUT_DIR"), "/library.rs"));
include!(concat!(env!("OUT_DIR"), "/group_pictures.rs"));

/// Maximum number of group files that one file uses, directly or indirectly.
const FILE_LIMIT: usize = 1000;

/// Returns the folder of the effect library: written below `folder` in release builds, unless it is there already.
///
/// # Errors
/// A file cannot be written.
#[cfg(library_included)]
pub fn effect_library(folder: &Path) -> Result<PathBuf, EngineError> {
    let mut hash = blake3::Hasher::new();
    for (path, text) in FILES {
        hash.update(path.as_bytes());
        hash.update(text);
    }
    let name = hash.finalize().to_hex();
    let root = folder.join(&name[..16]);
    for (path, text) in FILES {
        let file = root.join(path);
        if std::fs::read(&file).is_ok_and(|known| known == *text) {
            continue;
        }
        let parent = file.parent().unwrap_or(&root);
        std::fs::create_dir_all(parent)
            .map_err(|error| EngineError::new(ErrorKind::CannotWrite, format!("{}: {error}", parent.display())))?;
        write_whole(&file, text)?;
    }
    Ok(root)
}

/// Returns the folder of the effect library: that of the project in debug builds.
///
/// # Errors
/// The project is not there any more.
#[cfg(not(library_included))]
pub fn effect_library(_: &Path) -> Result<PathBuf, EngineError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs/library");
    root.canonicalize()
        .map_err(|error| EngineError::new(ErrorKind::MissingInput, format!("{}: {error}", root.display())))
}

/// Returns a square picture of a group of the effect library on a model, at most `side` pixels along a side. `None` for other files.
pub fn group_picture(file: &Path, side: u32) -> Option<Pixels> {
    let stem = file.file_stem()?.to_str()?;
    let (_, png) = GROUP_PICTURES.iter().find(|(name, _)| *name == stem)?;
    first_square(png, side)
}

/// Digest of a graph and of all group files that it leads to: two graphs with the same digest give the same group.
///
/// # Errors
/// A file cannot be read, or may not be opened.
pub fn group_digest(open: &OpenGraph) -> Result<String, EngineError> {
    let mut hash = blake3::Hasher::new();
    let mut known = BTreeSet::new();
    let mut next = vec![open.clone()];
    while let Some(open) = next.pop() {
        let key = open.path.canonicalize().unwrap_or_else(|_| open.path.clone());
        if known.len() == FILE_LIMIT || !known.insert(key) {
            continue;
        }
        hash.update(open.document.to_json().as_bytes());
        let inner: Result<Vec<OpenGraph>, EngineError> = files_named_in(&open.document)
            .map(|name| open.open_group(name))
            .collect();
        next.extend(inner?);
    }
    Ok(hash.finalize().to_hex().to_string())
}

/// Returns the group files that a document names, in the order of its nodes.
fn files_named_in(document: &Document) -> impl Iterator<Item = &str> {
    let groups = document.groups.values().map(|group| &group.graph);
    let graphs = std::iter::once(&document.graph).chain(groups);
    let nodes = graphs.flat_map(Graph::nodes).map(|(_, node)| node);
    let named = nodes
        .filter(|node| node.kind == GROUP_KIND)
        .filter_map(|node| node.group.as_deref());
    named.filter(|name| !document.groups.contains_key(*name))
}
