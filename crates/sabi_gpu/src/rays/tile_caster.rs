//! Ray caster of one tile on the processor. It searches around each place once for all rays of the place.

use sabi_nodes::kind::Finds;
use sabi_surface::bvh::Bvh;
use sabi_surface::near::{Known, NearTriangles, PlaceRay, Surroundings};

use super::hierarchy::RayScene;
use super::{HitRow, RayRow, TILE_TEXELS};

/// Maximum number of triangles near a tile that are examined before its rays are cast, in total and for each ray of a
/// place. With more triangles, examining them takes as long as casting.
const MOST_NEAR: usize = 512;
const NEAR_PER_RAY: usize = 24;

/// Caster of rays, one tile at a time. It keeps its memory from tile to tile.
#[derive(Default)]
pub(super) struct TileCaster {
    near: NearTriangles,
    around: Surroundings,
}

impl TileCaster {
    /// Casts the rays of a tile, working units, and writes what each hits.
    pub(super) fn cast(
        &mut self,
        scene: &RayScene<'_>,
        rays: &[RayRow],
        least_turn: Option<f32>,
        finds: Finds,
        hits: &mut [HitRow],
    ) {
        let scale = scene.working_from_model as f32;
        let of_texel = rays.len() / TILE_TEXELS;
        let most = (NEAR_PER_RAY * of_texel).min(MOST_NEAR);
        let is_near_known = self.near.find(scene.bvh, shot(rays, scale), most);
        for (rays, hits) in rays.chunks(of_texel.max(1)).zip(hits.chunks_mut(of_texel.max(1))) {
            if is_near_known {
                let shot = shot(rays, scale);
                self.around
                    .look(scene.bvh, &self.near, rays[0].triangle, shot, least_turn);
            } else {
                self.around.give_up();
            }
            for (row, hit) in rays.iter().zip(hits) {
                *hit = match row.reach > 0.0 {
                    true => self.cast_one(scene.bvh, row, scale, finds),
                    false => HitRow::MISS,
                };
            }
        }
    }

    fn cast_one(&self, bvh: &Bvh, row: &RayRow, scale: f32, finds: Finds) -> HitRow {
        let ray = place_ray(row, scale);
        let PlaceRay {
            origin,
            direction,
            reach,
        } = ray;
        let found = match self.around.closest(bvh, ray) {
            Known::Miss => None,
            Known::Hit(triangle, distance) => Some((triangle, distance)),
            Known::Nothing if finds == Finds::Any => bvh.any(origin, direction, reach).then_some((u32::MAX, 0.0)),
            Known::Nothing => {
                let found = bvh.closest(origin, direction, reach);
                found.map(|found| (found.triangle, found.distance))
            }
        };
        match found {
            None => HitRow::MISS,
            Some(_) if finds == Finds::Any => HitRow {
                distance: 0.0,
                triangle: u32::MAX,
            },
            Some((triangle, distance)) => HitRow {
                distance: distance * scale,
                triangle,
            },
        }
    }
}

/// Returns the rays that have a start and a length, in model units.
fn shot(rows: &[RayRow], scale: f32) -> impl Iterator<Item = PlaceRay> + Clone {
    let some = rows
        .iter()
        .filter(|row| row.reach > 0.0 && row.origin.iter().all(|x| x.is_finite()));
    some.map(move |row| place_ray(row, scale))
}

fn place_ray(row: &RayRow, scale: f32) -> PlaceRay {
    PlaceRay {
        origin: row.origin.map(|x| x / scale),
        direction: row.direction,
        reach: row.reach / scale,
    }
}
