//! Files that a bake of a graph on a model reads.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::{PathBase, TrustedPaths, named_path};

use super::model_files::files_of_model;
use super::named_files::NamedFiles;
use super::own_nodes::own_nodes;
use crate::error::EngineError;
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::phases::{Progress, unless_canceled};
use crate::source::strokes::{files_beside, paint_folder};

/// Files by names that do not depend on the location of the project.
pub type NamedInputs = BTreeMap<String, PathBuf>;

/// Lists the files of a graph: itself, group files, pictures, strokes, and node files of the artist. Files that are missing are
/// left out.
pub fn inputs_of_graph(open: &OpenGraph, kinds: &Kinds) -> NamedInputs {
    let named = NamedFiles::of(open.clone(), kinds);
    let graph = named_path(&open.path);
    let base = PathBase::of_file(&graph);
    let name = |path: &Path| {
        // A name that is not text cannot be in a graph.
        let written = base.write(path);
        written.unwrap_or_else(|_| path.to_string_lossy().into_owned())
    };
    let mut inputs = NamedInputs::new();
    for document in &named.documents {
        inputs.insert(name(&document.path), document.path.clone());
        let folder = paint_folder(&document.path);
        for file in files_beside(&document.path) {
            let path = folder.join(file);
            inputs.insert(name(&path), path);
        }
    }
    let pictures = named.pictures.into_iter();
    let pictures = pictures.filter(|(path, naming)| naming.refusal.is_none() && path.is_file());
    inputs.extend(pictures.map(|(path, _)| (name(&path), path)));
    let (nodes, _) = own_nodes(kinds, &Kinds::folders(Some(&open.path)), &named.documents);
    inputs.extend(nodes.into_iter().map(|(name, path)| (name, named_path(&path))));
    inputs
}

/// Lists the files of a model: itself, and those that it names.
///
/// # Errors
/// It cannot be loaded.
pub fn inputs_of_model(
    model: &Path,
    trusted: &TrustedPaths,
    progress: &dyn Progress,
) -> Result<NamedInputs, EngineError> {
    let (path, trusted) = (model.to_owned(), trusted.clone().with_file(model));
    let files = unless_canceled(progress, move || files_of_model(&path, &trusted))??.into_iter();
    Ok(files
        .map(|(place, path)| (format!("mesh/{place}"), named_path(&path)))
        .collect())
}
