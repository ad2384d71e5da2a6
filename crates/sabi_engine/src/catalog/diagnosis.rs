//! Report of Sabi's state on this machine, for `sabi doctor`; docs/report.md lists the keys.

use sabi_files::TrustedPaths;
use schemars::JsonSchema;
use serde::Serialize;

use crate::opening::kinds::Kinds;

/// Adapters, the cache, and node files with faults.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// Version of Sabi.
    pub sabi: &'static str,
    /// Adapters found.
    pub adapters: Vec<AdapterDescription>,
    /// True if an adapter could be opened.
    pub usable: bool,
    /// Error from opening an adapter, if none could be opened.
    pub problem: Option<String>,
    /// Folder of the cache.
    pub cache: Option<String>,
    /// Number of node kinds.
    pub nodes: usize,
    /// Faults of the user's node files.
    pub faults: Vec<String>,
}

/// An adapter and its driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct AdapterDescription {
    /// Name as the driver gives it.
    pub name: String,
    /// `cpu`, `integrated` or `discrete`.
    pub kind: String,
    /// Driver and its version.
    pub driver: String,
    /// Interface it is reached by, such as `vulkan`.
    pub backend: String,
}

/// Looks for adapters, the cache folder and the user's node files.
pub fn diagnose() -> Diagnosis {
    let adapters = sabi_gpu::adapters().into_iter().map(|adapter| AdapterDescription {
        kind: adapter.kind.to_string(),
        name: adapter.name,
        driver: adapter.driver,
        backend: adapter.backend,
    });
    let adapters = adapters.collect();
    let opened = sabi_gpu::Gpu::open(&sabi_gpu::AdapterChoice::Auto);
    let kinds = Kinds::beside(None, &TrustedPaths::default());
    Diagnosis {
        sabi: env!("CARGO_PKG_VERSION"),
        adapters,
        usable: opened.is_ok(),
        problem: opened.err().map(|error| error.to_string()),
        cache: crate::opening::default_cache_dir().map(|folder| folder.display().to_string()),
        nodes: kinds.library.kinds().count() + kinds.sources.len() + kinds.sinks.len(),
        faults: kinds.faults.iter().map(ToString::to_string).collect(),
    }
}
