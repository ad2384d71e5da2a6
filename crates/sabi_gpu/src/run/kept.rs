//! Results that are kept for later runs, since computing them again would take long.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use sabi_plan::{Plan, SlotRef, Step};

use super::Runner;
use crate::coverage::Coverages;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::needed_steps::{reads, writes};
use crate::rays::casts_on_device;
use crate::readback::read_texture;
use crate::result_key::ResultKey;
use crate::run_options::RunOptions;
use crate::source_fill::SourceFill;

/// Result size in bytes at which the computing time needed for keeping a result is twice that for a small one. With the
/// default time, a disk that reads and writes 250 MB per second needs that time for so many bytes.
const DOUBLING_BYTES: f64 = 62.5e6;

/// Results that are kept for later runs.
pub(super) struct KeptResults {
    keys: BTreeMap<SlotRef, ResultKey>,
    /// Slots whose results an earlier run kept.
    slots: BTreeSet<SlotRef>,
    /// Nodes whose kept results were read.
    nodes: BTreeSet<String>,
    /// Time to compute the value of a slot from the kept results.
    times: BTreeMap<SlotRef, Duration>,
}

impl KeptResults {
    pub(super) fn new(keys: BTreeMap<SlotRef, ResultKey>, slots: BTreeSet<SlotRef>) -> KeptResults {
        KeptResults {
            keys,
            slots,
            nodes: BTreeSet::new(),
            times: BTreeMap::new(),
        }
    }

    pub(super) fn into_nodes(self) -> Vec<String> {
        self.nodes.into_iter().collect()
    }
}

/// Slots whose results an earlier run kept.
pub(super) fn kept_slots(
    gpu: &Gpu,
    plan: &Plan,
    options: &RunOptions<'_>,
    sources: &dyn SourceFill,
) -> BTreeSet<SlotRef> {
    let keys = Coverages::of(plan, options.shown).slot_keys(plan).into_iter();
    keys.filter(|(_, key)| sources.has_result(&key_of_kept(gpu, key, options)))
        .map(|(slot, _)| slot)
        .collect()
}

/// Returns the key of a result for later runs: a hash of its content key and of everything that may change rounding.
fn key_of_kept(gpu: &Gpu, result: &ResultKey, options: &RunOptions<'_>) -> [u8; 32] {
    let adapter = gpu.summary();
    let mut hash = blake3::Hasher::new_derive_key("sabi kept results");
    for part in [
        adapter.name.as_bytes(),
        adapter.driver.as_bytes(),
        format!("{:?}", result.plane).as_bytes(),
    ] {
        hash.update(&(part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hash.update(&[u8::from(casts_on_device(gpu, options.caster))]);
    hash.update(&result.content);
    hash.update(result.tiles.as_ref().map_or(&[], <[u8; 32]>::as_slice));
    *hash.finalize().as_bytes()
}

impl Runner<'_> {
    /// Reads the kept results of slots that no step of this run has computed.
    pub(super) fn load_kept(&mut self, slots: &[SlotRef], sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        for slot in slots {
            let Some(kept) = &self.kept else { continue };
            if self.textures[*slot].is_some() || !kept.slots.contains(slot) {
                continue;
            }
            let key = key_of_kept(self.gpu, &kept.keys[slot], self.options);
            let bytes = sources.kept_result(&key).ok_or(GpuError::ResultGone)?;
            let (extent, format) = (self.extent(*slot)?, self.plan.slots[*slot].format);
            if bytes.len() as u64 != bytes_of(extent, format.texel_bytes()) {
                return Err(GpuError::ResultGone);
            }
            let texture = self.texture(*slot)?;
            self.upload(&texture, format, extent, &bytes);
            let nodes = self.nodes_of(*slot);
            if let Some(kept) = &mut self.kept {
                kept.nodes.extend(nodes);
            }
        }
        Ok(())
    }

    /// Returns the nodes of the step that writes a slot. The last node of a step computes its result.
    fn nodes_of(&self, slot: SlotRef) -> Option<String> {
        let step = self.plan.steps.iter().find(|step| writes(step).contains(&slot))?;
        match step {
            Step::Source(source) => Some(source.id.clone()),
            Step::Move(step) => Some(step.node.clone()),
            Step::Survey(step) => Some(step.node.clone()),
            Step::Kernel(kernel) => kernel.nodes.last().cloned(),
        }
    }

    /// Keeps the results of a step that has run, if computing them again would take long.
    pub(super) fn keep_results(&mut self, step: &Step, sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        let Some(kept) = &mut self.kept else {
            return Ok(());
        };
        let own = self.report.steps.last().map_or(Duration::ZERO, |time| time.run);
        let before = reads(step).into_iter().filter_map(|slot| kept.times.get(&slot));
        let time = own + before.sum::<Duration>();
        // Results of rays have a cache of their own, which is also used while a graph is edited.
        let is_of_rays = matches!(step, Step::Kernel(kernel) if kernel.rays.is_some());
        for slot in writes(step) {
            kept.times.insert(slot, if is_of_rays { Duration::ZERO } else { time });
        }
        if is_of_rays {
            return Ok(());
        }
        for slot in writes(step) {
            self.keep_result(slot, time, sources)?;
        }
        Ok(())
    }

    fn keep_result(&mut self, slot: SlotRef, time: Duration, sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        let (extent, format) = (self.extent(slot)?, self.plan.slots[slot].format);
        let doublings = bytes_of(extent, format.texel_bytes()) as f64 / DOUBLING_BYTES;
        let least = self.options.keeps_from.mul_f64(1.0 + doublings);
        let Some(kept) = self.kept.as_mut().filter(|_| time >= least) else {
            return Ok(());
        };
        if let (Some(key), Some(texture)) = (kept.keys.get(&slot), &self.textures[slot]) {
            let key = key_of_kept(self.gpu, key, self.options);
            let plane = read_texture(self.gpu, texture, extent, format)?;
            sources.keep_result(&key, plane.bytes());
            kept.times.insert(slot, Duration::ZERO);
        }
        Ok(())
    }
}

fn bytes_of([width, height, pages]: [u32; 3], texel_bytes: u64) -> u64 {
    u64::from(width) * u64::from(height) * u64::from(pages) * texel_bytes
}
