//! Inputs that all benches share.

use std::env;
use std::path::{Path, PathBuf};

use sabi_engine::AdapterChoice;

/// Adapter that `SABI_ADAPTER` names as `--adapter` does, else the one that a user gets.
pub(crate) fn adapter() -> AdapterChoice {
    match env::var("SABI_ADAPTER") {
        Ok(name) => match name.parse() {
            Ok(choice) => choice,
            Err(never) => match never {},
        },
        Err(_) => AdapterChoice::Auto,
    }
}

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
