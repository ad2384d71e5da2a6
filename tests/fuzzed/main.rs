//! Bodies of the fuzz targets, run on their seeds and on a damaged copy of each: keeps the targets compiling and checks
//! their guarantees on every machine, although only close to the seeds.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]
#![allow(unreachable_pub, reason = "the bodies belong to another crate")]

#[path = "../../fuzz/bodies/cache.rs"]
mod cache;
#[path = "../../fuzz/bodies/copy.rs"]
mod copy;
#[path = "../../fuzz/bodies/graph.rs"]
mod graph;
#[path = "../../fuzz/bodies/groups.rs"]
mod groups;
#[path = "../../fuzz/bodies/image.rs"]
mod image;
#[path = "../../fuzz/bodies/linked.rs"]
mod linked;
#[path = "../../fuzz/bodies/mesh.rs"]
mod mesh;
#[path = "../../fuzz/bodies/model.rs"]
mod model;
#[path = "../../fuzz/bodies/node.rs"]
mod node;
#[path = "../../fuzz/bodies/parts.rs"]
mod parts;
#[path = "../../fuzz/bodies/paths.rs"]
mod paths;
#[path = "../../fuzz/bodies/planning.rs"]
mod planning;
#[path = "../../crates/sabi_surface/tests/load/promises.rs"]
mod promises;
#[path = "../../fuzz/bodies/recovery.rs"]
mod recovery;
#[path = "../../fuzz/bodies/square.rs"]
mod square;
#[path = "../../fuzz/bodies/strokes.rs"]
mod strokes;

use std::fs;
use std::path::{Path, PathBuf};

use sabi_tests::project;

/// Every file below a folder, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    entries.into_iter().flat_map(below).collect()
}

/// Calls `survives` with each file below a folder, and with copies of it that are cut off or have bytes changed.
fn on_all(folder: &str, damages: usize, survives: fn(&[u8])) {
    let seeds = files(&project(folder));
    assert!(!seeds.is_empty(), "{folder} is empty");
    for seed in seeds {
        let whole = fs::read(&seed).unwrap();
        survives(&whole);
        for damage in 0..damages {
            let at = whole.len() * damage / damages;
            survives(&whole[..at]);
            let mut changed = whole.clone();
            changed[at] ^= 1 << (damage % 8);
            survives(&changed);
        }
    }
}

#[test]
fn graphs_survive() {
    on_all("graphs", 40, graph::survives);
}

#[test]
fn nodes_survive() {
    on_all("shaders/nodes", 12, node::survives);
    on_all("fuzz/seeds/node", 2, node::survives);
}

#[test]
fn gltf_files_survive() {
    on_all("fuzz/seeds/gltf", 400, model::survives_as_gltf);
}

#[test]
fn obj_files_survive() {
    on_all("fuzz/seeds/obj", 200, model::survives_as_obj);
}

#[test]
fn fbx_files_survive() {
    on_all("fuzz/seeds/fbx", 400, model::survives_as_fbx);
}

#[test]
fn collada_files_survive() {
    on_all("fuzz/seeds/dae", 400, model::survives_as_dae);
}

#[test]
fn ply_files_survive() {
    on_all("fuzz/seeds/ply", 300, model::survives_as_ply);
}

#[test]
fn stl_files_survive() {
    on_all("fuzz/seeds/stl", 200, model::survives_as_stl);
}

#[test]
fn pictures_survive() {
    on_all("fuzz/seeds/image", 100, image::survives);
}

#[test]
fn strokes_survive() {
    on_all("fuzz/seeds/strokes", 200, strokes::survives);
}

#[test]
fn group_files_survive() {
    on_all("fuzz/seeds/groups", 1, groups::survives);
}

#[test]
fn linked_nodes_survive() {
    on_all("fuzz/seeds/linked", 4, linked::survives);
    on_all("fuzz/seeds/node", 0, linked::survives);
}

#[test]
fn models_with_files_around_them_survive() {
    on_all("fuzz/seeds/paths", 4, paths::survives);
}

#[test]
fn copies_of_models_survive() {
    on_all("fuzz/seeds/copy", 40, copy::survives);
}

#[test]
fn meshes_survive() {
    on_all("fuzz/seeds/mesh", 1, mesh::survives);
}

#[test]
fn stored_results_survive() {
    on_all("fuzz/seeds/cache", 8, cache::survives);
}

#[test]
fn recoveries_survive() {
    on_all("fuzz/seeds/recovery", 40, recovery::survives);
}
