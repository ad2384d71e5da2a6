//! Shared parts of the test binaries: one device, graphs on models, and results with their positions on the surface.

mod bake_output;
mod device;
mod drawable_graph;
mod meshes;
mod node_files;
mod on_mesh;
mod places;
mod seams;
pub mod shapes;

use std::env;
use std::path::{Path, PathBuf};

pub use bake_output::{BakeOutput, report_file};
pub use device::{adapter, device};
pub use drawable_graph::{DrawableGraph, even_light};
pub use meshes::{MadeMesh, MadeTexture, MeshFile, Quad};
pub use node_files::NodeFolder;
pub use on_mesh::{EvaluationOptions, NodeResult, OnMesh, flat_graph};
pub use places::OnPage;
pub use seams::Seam;

/// Returns a path from the project's root. If tests run on another machine than the one that built them, `SABI_PROJECT` names the root.
pub fn project(path: &str) -> PathBuf {
    let built_from = || Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    env::var_os("SABI_PROJECT")
        .map_or_else(built_from, PathBuf::from)
        .join(path)
}

/// Lowest and highest of some numbers.
pub fn extent(values: impl IntoIterator<Item = f32>) -> [f32; 2] {
    values
        .into_iter()
        .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
}

/// Returns the length of a range, or 1 if it is zero. Tolerances are shares of it.
pub fn range(values: impl IntoIterator<Item = f32>) -> f64 {
    let [low, high] = extent(values);
    let range = f64::from(high) - f64::from(low);
    if range.is_finite() && range > 1e-6 { range } else { 1.0 }
}
