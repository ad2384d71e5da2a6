//! Inputs that all benches share.

mod adapter;

use std::env;
use std::path::{Path, PathBuf};

pub(crate) use adapter::adapter;

/// Returns the root of the project: `SABI_PROJECT` if a bench runs on another machine than the one that built it.
pub(crate) fn root() -> PathBuf {
    env::var_os("SABI_PROJECT").map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), PathBuf::from)
}

/// Returns the peer model of 30 000 triangles if the shared data folder exists beside the project, otherwise the figure.
pub(crate) fn peer_model() -> PathBuf {
    let shared = root().join("../shared/data/meshes/bench-suzanne30k/mesh30k.glb");
    if shared.is_file() {
        shared
    } else {
        root().join("assets/meshes/figure.glb")
    }
}
