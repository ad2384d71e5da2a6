//! The one device of a test binary.

use std::env;
use std::sync::{Arc, OnceLock};

use sabi_engine::{AdapterChoice, Gpu};

/// Adapter of all tests: the software one, which goldens are made on and every machine can have, or the one that
/// `SABI_ADAPTER` names, as `cargo xtask gpu` does for each.
pub fn adapter() -> AdapterChoice {
    match env::var("SABI_ADAPTER") {
        Ok(name) => AdapterChoice::Named(name),
        Err(_) => AdapterChoice::Cpu,
    }
}

/// The device of all tests of a binary, on [`adapter`].
///
/// # Panics
/// With the command that installs one, where there is none: a test that cannot run is not a test that passed.
pub fn device() -> Arc<Gpu> {
    static DEVICE: OnceLock<Arc<Gpu>> = OnceLock::new();
    let open = || match Gpu::open(&adapter()) {
        Ok(gpu) => Arc::new(gpu),
        Err(error) => panic!(
            "These tests need the adapter `{}`: {error}\nInstall Mesa's software one with\n    sudo apt-get install --yes \
             mesa-vulkan-drivers\nor run `cargo xtask test`, which does so.",
            adapter()
        ),
    };
    DEVICE.get_or_init(open).clone()
}
