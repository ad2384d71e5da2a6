//! The one device of a test binary.

use std::sync::{Arc, OnceLock};

use sabi_engine::{AdapterChoice, Gpu};

/// The software adapter: goldens are made on it, and every machine can have it.
///
/// # Panics
/// With the command that installs one, where there is none: a test that cannot run is not a test that passed.
pub fn device() -> Arc<Gpu> {
    static DEVICE: OnceLock<Arc<Gpu>> = OnceLock::new();
    let open = || match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) => Arc::new(gpu),
        Err(error) => panic!(
            "These tests need a software Vulkan driver: {error}\nInstall Mesa's with\n    sudo apt-get install --yes \
             mesa-vulkan-drivers\nor run `cargo xtask test`, which does so."
        ),
    };
    DEVICE.get_or_init(open).clone()
}
