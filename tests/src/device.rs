//! The devices of a test binary.

use std::env;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::available_parallelism;

use sabi_gpu::{AdapterChoice, Gpu};

/// Returns the adapter of all tests: the software adapter, on which goldens are made and which every machine can have, or
/// the one that `SABI_ADAPTER` names, as `cargo xtask gpu` does for each.
pub fn adapter() -> AdapterChoice {
    match env::var("SABI_ADAPTER") {
        Ok(name) => AdapterChoice::Named(name),
        Err(_) => AdapterChoice::Cpu,
    }
}

/// A device on [`adapter`], always the same one for a thread. There are as many as processors, since a device compiles one kernel at a
/// time, and tests wait for that more than for anything else.
///
/// # Panics
/// With the command that installs one, where there is none: a test that cannot run is not a test that passed.
pub fn device() -> Arc<Gpu> {
    static DEVICES: OnceLock<Vec<OnceLock<Arc<Gpu>>>> = OnceLock::new();
    static THREADS: AtomicUsize = AtomicUsize::new(0);
    thread_local! {
        static THREAD: usize = THREADS.fetch_add(1, Ordering::Relaxed);
    }
    let count = available_parallelism().map_or(1, usize::from);
    let devices = DEVICES.get_or_init(|| (0..count).map(|_| OnceLock::new()).collect());
    let own = THREAD.with(|thread| thread % count);
    let open = || match Gpu::open(&adapter()) {
        Ok(gpu) => Arc::new(gpu),
        Err(error) => panic!(
            "These tests need the adapter `{}`: {error}\nInstall Mesa's software one with\n    sudo apt-get install --yes \
             mesa-vulkan-drivers\nor run `cargo xtask test`, which does so.",
            adapter()
        ),
    };
    devices[own].get_or_init(open).clone()
}
