//! Inputs that all benches share.

mod adapter;

use std::env;
use std::path::{Path, PathBuf};

pub(crate) use adapter::adapter;

/// Root of the project: `SABI_PROJECT` where a bench runs on another machine than the one that built it.
pub(crate) fn root() -> PathBuf {
    env::var_os("SABI_PROJECT").map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), PathBuf::from)
}

/// The 30 000-triangle peer model where the shared data folder is beside the project, else the figure.
pub(crate) fn peer_model() -> PathBuf {
    let shared = root().join("../shared/data/meshes/bench-suzanne30k/mesh30k.glb");
    if shared.is_file() {
        shared
    } else {
        root().join("assets/meshes/figure.glb")
    }
}
