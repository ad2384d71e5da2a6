//! Results of a run and its report.

use std::collections::BTreeMap;
use std::time::Duration;

use sabi_plan::{Plan, SlotRef};

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
    /// Results whose differences from results of before are known.
    pub(crate) changed: ChangedResults,
}

impl Run {
    /// Bytes of all its textures and of the surface.
    pub fn bytes(&self) -> u64 {
        self.pool.report().bytes
    }

    /// Frees the textures that hold no results.
    pub fn drop_unused(&mut self) {
        self.pool.drop_free();
    }

    /// Frees the texture of a result that was read for the last time. The results of a run with a cache belong to that.
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
    /// Time for linking the kernels of nodes, making their pipelines and their first dispatch, when software drivers
    /// compile. The fixed kernels of this crate are not counted.
    pub compile: Duration,
    /// Time of everything else.
    pub run: Duration,
    /// Steps that ran, without those whose results were cached.
    pub steps: Vec<StepTime>,
    /// Number of them in which only tiles were computed that differ from results of before.
    pub steps_in_part: usize,
    /// Texels of the tiles that kernels ran over, added up over all of them and their repetitions.
    pub texels: u64,
    /// Part of `run` in which ghosts were filled, if that was measured.
    pub ghosts: Duration,
    /// True if some results follow from cached hits of longer rays, and so may differ by rounding.
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
    /// Time from its start until the device is done with it, without compiling.
    pub run: Duration,
}
