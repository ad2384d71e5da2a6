//! The project's own models, written as GLB: the same bytes on every run.

mod ball;
mod bar;
mod barrel;
mod bench;
mod chain;
mod chair;
mod charted_mesh;
mod column;
mod crate_box;
mod figure;
mod fixings;
pub(crate) mod glb;
mod hoop;
mod lathe;
mod outline;
mod pack;
mod solids;
mod sweep;
mod table;
#[cfg(test)]
mod tests;
mod wall;

use std::path::Path;

use glb::Model;

use xtask::project::{Project, TaskError, create_folder, write_file};

/// A model's name and what makes it.
type Maker = (&'static str, fn() -> Model);

/// Every model this project makes.
const MAKERS: [Maker; 11] = [
    ("bench", bench::bench),
    ("figure", figure::figure),
    ("sphere", solids::sphere),
    ("cube", solids::cube),
    ("chair", chair::chair),
    ("table", table::table),
    ("crate", crate_box::crate_box),
    ("barrel", barrel::barrel),
    ("chain", chain::chain),
    ("column", column::column),
    ("wall", wall::wall),
];

/// A model by its name.
pub(crate) fn model(name: &str) -> Option<Model> {
    MAKERS.iter().find(|(own, _)| *own == name).map(|(_, make)| make())
}

/// Writes all models into the project.
pub(crate) fn write_all(project: &Project) -> Result<(), TaskError> {
    let folder = project.root.join("assets/meshes");
    MAKERS.iter().try_for_each(|(_, make)| {
        let model = make();
        write(&model, &folder.join(format!("{}.glb", model.name)))
    })
}

/// Writes the figure in more than a million triangles.
pub(crate) fn write_million(path: &Path) -> Result<(), TaskError> {
    write(&figure::million(), path)
}

/// Writes a model, and prints its size.
fn write(model: &Model, path: &Path) -> Result<(), TaskError> {
    let bytes = glb::encode(model);
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    write_file(path, &bytes)?;
    let triangles: usize = model.parts.iter().map(|part| part.shape.triangles.len()).sum();
    eprintln!(
        "{}: {} parts, {triangles} triangles, {} KiB",
        path.display(),
        model.parts.len(),
        bytes.len().div_ceil(1024)
    );
    Ok(())
}
