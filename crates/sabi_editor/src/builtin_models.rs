//! Models that come with the program, by the names that graphs have for them.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::Session;
use sabi_files::{Refusal, Unread};

use crate::paths::canonical_if_present;

/// Folder of the models in the folder of examples, as in the project.
pub(crate) const MESHES: &str = "assets/meshes";

macro_rules! models {
    ($($name:literal)*) => {
        [$(($name, include_bytes!(concat!("../../../assets/meshes/", $name)).as_slice()),)*]
    };
}

/// Models of the examples. New graphs are shown on the first one.
pub(crate) const MODELS: [(&str, &[u8]); 11] = models![
    "bench.glb" "barrel.glb" "chain.glb" "chair.glb" "column.glb" "crate.glb" "cube.glb" "figure.glb" "sphere.glb" "table.glb"
    "wall.glb"
];

/// File of a built-in model by its name in graphs, whether it was written or not; `None` if there is no such model.
pub(crate) fn builtin_file(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut models = MODELS.iter().map(|(file, _)| *file);
    let file = models.find(|file| Path::new(file).file_stem().is_some_and(|stem| stem == name))?;
    Some(folder.join(MESHES).join(file))
}

/// Name in graphs of a built-in model; `None` for other files, and for one that was changed since it was written.
pub(crate) fn builtin_name(folder: &Path, file: &Path) -> Option<String> {
    let is_same = |own: &PathBuf| canonical_if_present(own) == canonical_if_present(file);
    let (own, bytes) = MODELS
        .into_iter()
        .map(|(name, bytes)| (folder.join(MESHES).join(name), bytes))
        .find(|(own, _)| is_same(own))?;
    let is_unchanged = fs::read(&own).is_ok_and(|read| read == bytes);
    let name = own.file_stem().filter(|_| is_unchanged)?;
    Some(name.to_string_lossy().into_owned())
}

/// File of the model that a graph names, or the reason that the graph may not open it. Built-in models are in the folder `examples`.
pub(crate) fn model_of(session: &Session, examples: Option<&Path>) -> Option<Result<PathBuf, Refusal>> {
    let preview = session.document().preview.as_ref()?;
    let named = preview.mesh.clone()?;
    if let Some(file) = examples
        .zip(preview.builtin_mesh())
        .and_then(|(folder, name)| builtin_file(folder, name))
    {
        return Some(Ok(file));
    }
    let graph = session.graph();
    Some(match graph.trusted.check(&graph.base(), &named) {
        Err(Unread::Refused(refusal)) => Err(refusal),
        // Other errors are reported when the file is read.
        _ => Ok(graph.base().resolve(&named)),
    })
}
