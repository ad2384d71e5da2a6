//! The project's own models, written as GLB: the same bytes on every run.

mod ball;
mod bench;
mod figure;
mod glb;
mod outline;
mod pack;
mod shape;
mod solids;
mod sweep;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::Path;

use glb::Model;

use crate::place::Stop;

/// Every model this project makes.
fn models() -> [Model; 4] {
    [bench::bench(), figure::figure(), solids::sphere(), solids::cube()]
}

/// Writes them all below the project's root and says what was written.
pub(crate) fn write(root: &Path) -> Result<(), Stop> {
    let folder = root.join("assets/meshes");
    let cannot = |error| Stop::new(1, format!("{} cannot be written: {error}.", folder.display()));
    fs::create_dir_all(&folder).map_err(cannot)?;
    for model in models() {
        let bytes = glb::encode(&model);
        let triangles: usize = model.parts.iter().map(|part| part.shape.triangles.len()).sum();
        fs::write(folder.join(format!("{}.glb", model.name)), &bytes).map_err(cannot)?;
        eprintln!(
            "assets/meshes/{}.glb: {} parts, {triangles} triangles, {} KiB",
            model.name,
            model.parts.len(),
            bytes.len().div_ceil(1024)
        );
    }
    Ok(())
}
