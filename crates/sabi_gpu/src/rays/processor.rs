//! Ray caster on all cores of the processor.

use std::collections::VecDeque;

use rayon::prelude::*;
use sabi_nodes::kind::Finds;

use super::hierarchy::RayScene;
use super::{HitRow, RayBufferSet, RayRow};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::readback::Mapping;

/// Rays that a thread casts at a time.
const RAYS_PER_TASK: usize = 1024;

/// Ray caster on the processor. It reads rays in the mapped buffer, since copies of hundreds of megabytes would take time.
pub(crate) struct ProcessorCaster<'a> {
    scene: RayScene<'a>,
    /// Pending mappings of slices, oldest first.
    pending: VecDeque<Mapping>,
    hits: Vec<HitRow>,
}

impl<'a> ProcessorCaster<'a> {
    pub(super) fn new(scene: RayScene<'a>) -> ProcessorCaster<'a> {
        ProcessorCaster {
            scene,
            pending: VecDeque::new(),
            hits: Vec::new(),
        }
    }

    /// Requests the readback of rays.
    pub(super) fn begin(&mut self, gpu: &Gpu, set: &RayBufferSet, rays: usize) -> Result<(), GpuError> {
        let bytes = (rays * size_of::<RayRow>()) as u64;
        self.pending
            .push_back(gpu.start_mapping(&set.rays, &set.staging, bytes));
        Ok(())
    }

    /// Casts the rays of the oldest slice and uploads their hits.
    pub(super) fn finish(&mut self, gpu: &Gpu, set: &RayBufferSet, rays: usize, finds: Finds) -> Result<(), GpuError> {
        let Some(mapping) = self.pending.pop_front() else {
            return Ok(());
        };
        self.hits.resize(rays, HitRow::MISS);
        let (scene, hits) = (&self.scene, &mut self.hits);
        gpu.finish_mapping(mapping, &set.staging, |bytes| {
            cast(scene, bytemuck::cast_slice(bytes), finds, hits);
        })?;
        gpu.queue.write_buffer(&set.hits, 0, bytemuck::cast_slice(&self.hits));
        Ok(())
    }
}

/// Casts rays. Rays and hits are in working units, the hierarchy is in model units.
fn cast(scene: &RayScene<'_>, rays: &[RayRow], finds: Finds, hits: &mut [HitRow]) {
    let (bvh, scale) = (scene.bvh, scene.working_from_model as f32);
    let cast_one = |(ray, hit): (&RayRow, &mut HitRow)| {
        if ray.reach <= 0.0 {
            *hit = HitRow::MISS;
            return;
        }
        let (origin, reach) = (ray.origin.map(|x| x / scale), ray.reach / scale);
        *hit = match finds {
            Finds::Any if bvh.any(origin, ray.direction, reach) => HitRow {
                distance: 0.0,
                triangle: u32::MAX,
            },
            Finds::Any => HitRow::MISS,
            Finds::Nearest => bvh
                .closest(origin, ray.direction, reach)
                .map_or(HitRow::MISS, |found| HitRow {
                    distance: found.distance * scale,
                    triangle: found.triangle,
                }),
        };
    };
    rays.par_iter()
        .zip(hits.par_iter_mut())
        .with_min_len(RAYS_PER_TASK)
        .for_each(cast_one);
}
