//! Ray caster on all cores of the processor.

use std::collections::VecDeque;

use rayon::prelude::*;
use sabi_nodes::kind::Finds;

use super::hierarchy::RayScene;
use super::tile_caster::TileCaster;
use super::{CastRays, HitRow, RayBufferSet, RayRow};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::readback::PendingCopy;

/// Rays that a thread casts at a time.
const RAYS_PER_TASK: usize = 1024;
/// Ray caster on the processor. It reads the rays in the mapped buffer, since copying hundreds of megabytes would take long.
pub(crate) struct ProcessorCaster<'a> {
    scene: RayScene<'a>,
    /// Pending copies of the rays of slices, oldest first.
    pending: VecDeque<PendingCopy>,
    hits: Vec<HitRow>,
    rays: CastRays,
}

impl<'a> ProcessorCaster<'a> {
    pub(super) fn new(scene: RayScene<'a>, rays: CastRays) -> ProcessorCaster<'a> {
        ProcessorCaster {
            scene,
            pending: VecDeque::new(),
            hits: Vec::new(),
            rays,
        }
    }

    /// Requests the readback of rays.
    pub(super) fn begin(&mut self, gpu: &Gpu, set: &RayBufferSet, rays: usize) -> Result<(), GpuError> {
        let bytes = (rays * size_of::<RayRow>()) as u64;
        self.pending.push_back(set.staging.copy_buffer(gpu, &set.rays, bytes));
        Ok(())
    }

    /// Casts the rays of the oldest slice and uploads their hits.
    pub(super) fn finish(&mut self, gpu: &Gpu, set: &RayBufferSet, rays: usize, finds: Finds) -> Result<(), GpuError> {
        let Some(copy) = self.pending.pop_front() else {
            return Ok(());
        };
        self.hits.resize(rays, HitRow::MISS);
        let (scene, known, hits) = (&self.scene, self.rays, &mut self.hits);
        set.staging.read(gpu, copy, |bytes| {
            cast(scene, bytemuck::cast_slice(bytes), known, finds, hits);
        })?;
        gpu.queue.write_buffer(&set.hits, 0, bytemuck::cast_slice(&self.hits));
        Ok(())
    }
}

/// Casts rays, tile by tile. Rays and hits are in working units, the hierarchy is in model units.
fn cast(scene: &RayScene<'_>, rays: &[RayRow], known: CastRays, finds: Finds, hits: &mut [HitRow]) {
    rays.par_chunks(known.of_tile)
        .zip(hits.par_chunks_mut(known.of_tile))
        .with_min_len(RAYS_PER_TASK.div_ceil(known.of_tile))
        .for_each_init(TileCaster::default, |caster, (rays, hits)| {
            caster.cast(scene, rays, known.least_turn, finds, hits);
        });
}
