//! Follows rays on the processor, on all its cores.

use rayon::prelude::*;
use sabi_gpu::{HitRow, RayRow};
use sabi_nodes::kind::Finds;
use sabi_surface::bvh::Bvh;

/// Rays that a thread follows at a time.
const PART: usize = 1024;

/// What each ray hits. Rays and hits are in working units, the hierarchy is in the model's own.
pub(crate) fn cast(bvh: &Bvh, working_from_model: f64, rays: &[RayRow], finds: Finds, hits: &mut [HitRow]) {
    let scale = working_from_model as f32;
    let follow = |(ray, hit): (&RayRow, &mut HitRow)| {
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
        .with_min_len(PART)
        .for_each(follow);
}
