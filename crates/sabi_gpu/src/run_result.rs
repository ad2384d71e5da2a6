//! Results of a run and its report.

use std::collections::BTreeMap;
use std::time::Duration;

use sabi_plan::{Plan, SlotRef};

use crate::error::GpuError;
use crate::pool::{PoolReport, TexturePool};
use crate::result_key::{ChangedResults, ResultKey};

/// Results of a plan on the device.
pub struct Run {
    pub(crate) textures: Vec<Option<wgpu::Texture>>,
    /// Times and memory.
    pub report: RunReport,
    pub(crate) pool: TexturePool,
    /// Keys of results.
    pub(crate) keys: BTreeMap<SlotRef, ResultKey>,
    /// Results whose differences from earlier results are known.
    pub(crate) changed: ChangedResults,
}

impl Run {
    /// Bytes of all its textures and of the surface.
    pub fn bytes(&self) -> u64 {
        self.pool.report().bytes
    }

    /// Returns the texture of a result that the plan kept. It is an array of pages.
    pub fn texture(&self, slot: SlotRef) -> Result<wgpu::Texture, GpuError> {
        let found = self.textures.get(slot).and_then(Option::as_ref);
        let missing = || GpuError::Defect("a result was requested that the plan did not keep".into());
        found.cloned().ok_or_else(missing)
    }

    /// Frees the textures that hold no results.
    pub fn drop_unused(&mut self) {
        self.pool.drop_free();
    }

    /// Frees the texture of a result that is not read again. A cache keeps its own reference to the texture.
    pub fn free(&mut self, plan: &Plan, slot: SlotRef) {
        let texture = self.textures.get_mut(slot).and_then(Option::take);
        if let Some((texture, slot)) = texture.zip(plan.slots.get(slot)) {
            self.pool.discard(slot.format, &texture);
        }
    }
}

/// Report of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunReport {
    /// Time for linking the kernels of nodes, creating their pipelines, and their first dispatch, in which software drivers
    /// compile them. The fixed kernels of this crate are not included.
    pub compile: Duration,
    /// Time of everything else.
    pub run: Duration,
    /// Steps that ran. Steps with cached results are not included.
    pub steps: Vec<StepTime>,
    /// Number of these steps that computed only the tiles that differ from earlier results.
    pub steps_in_part: usize,
    /// Number of texels of the tiles over which kernels ran, summed over all kernels and repetitions.
    pub texels: u64,
    /// Part of `run` spent on filling ghosts, if that was measured.
    pub ghosts: Duration,
    /// True if some results were derived from cached hits of longer rays, so that they may differ by rounding.
    pub has_cached_hits: bool,
    /// Nodes whose rays were not cast, since their results were on disk.
    pub found_on_disk: Vec<String>,
    /// Nodes whose results were kept by an earlier run and read instead of computed.
    pub kept_results: Vec<String>,
    /// Texture memory, that of the surface included.
    pub pool: PoolReport,
}

/// Time of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepTime {
    /// Nodes in it, each with its share of the estimated cost.
    pub nodes: Vec<(String, f32)>,
    /// Time from its start until the device has finished it, without compiling.
    pub run: Duration,
}
