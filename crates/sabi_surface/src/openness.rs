//! Openness of a model's surface to light from all directions, on a separate small atlas.

use std::f32::consts::TAU;
use std::path::Path;

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use sabi_files::{Cache, CacheKind};

use crate::atlas::{Atlas, AtlasError, AtlasOptions, EMPTY, GHOST_BIT, Ghost, atlas_key};
use crate::bvh::Bvh;
use crate::model::Mesh;

/// Texels for one unit of UV.
const SIZE: u32 = 256;
/// Number of rays for each texel.
const RAYS: usize = 48;
/// Length of the rays, as a share of the model's largest side. Farther surfaces do not block light.
const REACH: f32 = 0.3;
/// Angle from a ray to the next one around the normal: the golden angle.
const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// Kind of cached openness. Its version must be changed whenever the computation changes.
const KIND: CacheKind = CacheKind {
    prefix: "openness",
    version: 2,
    limit_bytes: 256 << 20,
};

/// Openness of a surface: for each texel of a small atlas the mean open direction and the open share.
#[derive(Clone, Debug, PartialEq)]
pub struct Openness {
    /// Texels for one unit of UV.
    pub size: u32,
    /// Width and height of a page.
    pub page_size: [u32; 2],
    /// Number of pages.
    pub pages: u32,
    /// For each chart, the offset that is added to `uv × size` to get texel coordinates, and its page.
    pub charts: Vec<[i32; 3]>,
    /// Page by page and row by row: the mean open direction in model space, −1..1 as 0..255, and the share that is open.
    pub texels: Vec<[u8; 4]>,
}

impl Openness {
    /// Computes the openness of a mesh with rays, or reads it from a cache folder, for the charts of `atlas`, which is used for rendering.
    pub fn of(mesh: &Mesh, atlas: &Atlas, bvh: &Bvh, cache_dir: Option<&Path>) -> Result<Openness, AtlasError> {
        let options = AtlasOptions::new(SIZE);
        let cache = cache_dir.map(|folder| Cache::new(folder, KIND));
        // The division into charts depends on the size of the atlas used for rendering.
        let mut hasher = blake3::Hasher::new();
        hasher.update(&atlas_key(mesh, &options));
        hasher.update(bytemuck::cast_slice(&atlas.triangle_chart));
        let key = *hasher.finalize().as_bytes();
        let stored = cache.as_ref().and_then(|cache| cache.read(&key));
        if let Some(known) = stored.and_then(|bytes| Openness::decode(&bytes, atlas.charts.len())) {
            return Ok(known);
        }
        let small = atlas.rebuild(mesh, SIZE, options.page_limit)?;
        let charts = small.charts.iter().map(|chart| {
            let [u, v] = chart.texel_from_uv;
            [u, v, chart.page as i32]
        });
        let found = Openness {
            size: small.size,
            page_size: small.page_size,
            pages: small.pages,
            charts: charts.collect(),
            texels: Finder::new(mesh, &small, bvh).texels(),
        };
        if let Some(cache) = &cache {
            // If it cannot be stored, it is computed again next time.
            let _ = cache.write(&key, &found.encode());
        }
        Ok(found)
    }

    fn encode(&self) -> Vec<u8> {
        let [width, height] = self.page_size;
        let head = [width, height, self.pages];
        [
            bytemuck::cast_slice(&head),
            bytemuck::cast_slice(&self.charts),
            self.texels.as_flattened(),
        ]
        .concat()
    }

    /// Returns the stored openness of `charts` charts; `None` if the data is damaged.
    fn decode(bytes: &[u8], charts: usize) -> Option<Openness> {
        let (head, rest) = bytes.split_at_checked(3 * size_of::<u32>())?;
        let (places, texels) = rest.split_at_checked(charts.checked_mul(size_of::<[i32; 3]>())?)?;
        let [width, height, pages] = bytemuck::pod_collect_to_vec(head).try_into().ok()?;
        let count = u64::from(width)
            .checked_mul(u64::from(height))?
            .checked_mul(u64::from(pages))?;
        let is_whole = Some(texels.len() as u64) == count.checked_mul(4);
        is_whole.then(|| Openness {
            size: SIZE,
            page_size: [width, height],
            pages,
            charts: bytemuck::pod_collect_to_vec(places),
            texels: texels.as_chunks::<4>().0.to_vec(),
        })
    }
}

/// Mean open direction, not of unit length, and open share.
type OpenDirection = [f32; 4];

struct Finder<'a> {
    mesh: &'a Mesh,
    atlas: &'a Atlas,
    bvh: &'a Bvh,
    reach: f32,
}

impl<'a> Finder<'a> {
    fn new(mesh: &'a Mesh, atlas: &'a Atlas, bvh: &'a Bvh) -> Finder<'a> {
        let used = mesh.triangles.iter().flatten();
        let places = used.map(|vertex| Vec3::from(mesh.positions[*vertex as usize]));
        let (low, high) = places
            .filter(|place| place.is_finite())
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), place| {
                (low.min(place), high.max(place))
            });
        let side = (high - low).max_element();
        Finder {
            mesh,
            atlas,
            bvh,
            reach: if side.is_finite() { REACH * side } else { 0.0 },
        }
    }

    fn texels(&self) -> Vec<[u8; 4]> {
        let found: Vec<OpenDirection> = (0..self.atlas.owners.len())
            .into_par_iter()
            .map(|index| match self.atlas.owners[index] {
                owner if owner == EMPTY || owner & GHOST_BIT != 0 => [0.0, 0.0, 0.0, 1.0],
                owner => self.open_at(index, owner as usize),
            })
            .collect();
        // Smooth twice, since a texel is noisy with so few rays. In between, ghosts carry the values across seams.
        let smoothed = self.smoothed(&self.with_ghosts(found));
        let smoothed = self.smoothed(&self.with_ghosts(smoothed));
        self.with_ghosts(smoothed).into_iter().map(encoded).collect()
    }

    /// Position and normal on a triangle at texel coordinates.
    fn place(&self, triangle: usize, texel: DVec2) -> (DVec3, DVec3) {
        let [a, b, c] = self.atlas.triangle_texels[triangle].map(|texel| Vec2::from(texel).as_dvec2());
        let area = (b - a).perp_dot(c - a);
        let (v, w) = match area.abs() > 1e-12 {
            true => ((texel - a).perp_dot(c - a) / area, (b - a).perp_dot(texel - a) / area),
            false => (0.0, 0.0),
        };
        let corner =
            |rows: &[[f32; 3]], at: usize| Vec3::from(rows[self.mesh.triangles[triangle][at] as usize]).as_dvec3();
        let mixed = |rows: &[[f32; 3]]| {
            let [first, second, third] = [0, 1, 2].map(|at| corner(rows, at));
            first + (second - first) * v + (third - first) * w
        };
        (mixed(&self.mesh.positions), mixed(&self.mesh.normals))
    }

    fn open_at(&self, index: usize, triangle: usize) -> OpenDirection {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let texel = DVec2::new((index % width) as f64 + 0.5, ((index / width) % height) as f64 + 0.5);
        let (position, normal) = self.place(triangle, texel);
        let Some(normal) = normal.as_vec3().try_normalize() else {
            return [0.0, 0.0, 0.0, 1.0];
        };
        let (side, forward) = normal.any_orthonormal_pair();
        let origin = (position.as_vec3() + normal * (1e-3 * self.reach)).to_array();
        // Neighbors use different rotations, so that no pattern of rays is visible.
        let turn = (index as f32 * 0.618_034).fract() * TAU;
        let mut mean = Vec3::ZERO;
        let mut open = 0.0;
        for ray in 0..RAYS {
            let share = (ray as f32 + 0.5) / RAYS as f32;
            let (sin, cos) = (turn + ray as f32 * GOLDEN_ANGLE).sin_cos();
            let flat = share.sqrt();
            let towards = side * (flat * cos) + forward * (flat * sin) + normal * (1.0 - share).sqrt();
            let hit = self.bvh.closest(origin, towards.to_array(), self.reach);
            let passes = hit.map_or(1.0, |hit| hit.distance / self.reach);
            mean += towards * passes;
            open += passes;
        }
        let share = 1.0 / RAYS as f32;
        [mean.x * share, mean.y * share, mean.z * share, open * share]
    }

    /// Returns the values with the ghosts filled from the other sides of the seams.
    fn with_ghosts(&self, mut values: Vec<OpenDirection>) -> Vec<OpenDirection> {
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let at = |values: &[OpenDirection], x: i64, y: i64, page: usize| {
            let [x, y] = [x.clamp(0, width as i64 - 1), y.clamp(0, height as i64 - 1)];
            values[(page * height + y as usize) * width + x as usize]
        };
        let mix = |a: OpenDirection, b: OpenDirection, t: f32| -> OpenDirection {
            std::array::from_fn(|part| a[part] + (b[part] - a[part]) * t)
        };
        let beyond = |ghost: &Ghost| {
            let chart = &self.atlas.charts[self.atlas.triangle_chart[ghost.target_triangle as usize] as usize];
            let target = Vec2::from(ghost.target_texel) - 0.5;
            let corner = target.floor();
            let weight = target - corner;
            let (x, y, page) = (corner.x as i64, corner.y as i64, chart.page as usize);
            let row = |y: i64| mix(at(&values, x, y, page), at(&values, x + 1, y, page), weight.x);
            let value = mix(row(y), row(y + 1), weight.y);
            let [x, y, page] = ghost.texel.map(|at| at as usize);
            ((page * height + y) * width + x, value)
        };
        let beyond: Vec<(usize, OpenDirection)> = self.atlas.ghosts.iter().map(beyond).collect();
        for (own, value) in beyond {
            values[own] = value;
        }
        values
    }

    /// Returns the mean over 3 × 3 texels with binomial weights. Texels without a place do not count.
    fn smoothed(&self, values: &[OpenDirection]) -> Vec<OpenDirection> {
        let width = self.atlas.page_size[0] as i64;
        let owners = &self.atlas.owners;
        let mean = |index: usize| {
            if owners[index] == EMPTY || owners[index] & GHOST_BIT != 0 {
                return values[index];
            }
            let mut sum = [0.0; 4];
            let mut weights = 0.0;
            for (step, weight) in STEPS {
                let other = index as i64 + step[0] + step[1] * width;
                let Some(owner) = usize::try_from(other).ok().and_then(|other| owners.get(other)) else {
                    continue;
                };
                if *owner != EMPTY {
                    let value = values[other as usize];
                    sum = std::array::from_fn(|part| sum[part] + weight * value[part]);
                    weights += weight;
                }
            }
            sum.map(|part: f32| part / weights)
        };
        (0..owners.len()).into_par_iter().map(mean).collect()
    }
}

/// Neighbors of a texel with their binomial weights.
const STEPS: [([i64; 2], f32); 9] = [
    ([-1, -1], 1.0),
    ([0, -1], 2.0),
    ([1, -1], 1.0),
    ([-1, 0], 2.0),
    ([0, 0], 4.0),
    ([1, 0], 2.0),
    ([-1, 1], 1.0),
    ([0, 1], 2.0),
    ([1, 1], 1.0),
];

fn encoded([x, y, z, open]: OpenDirection) -> [u8; 4] {
    let direction = Vec3::new(x, y, z).normalize_or_zero();
    let [x, y, z] = (direction * 127.5 + 127.5).to_array();
    [x, y, z, open * 255.0].map(|part| part.round().clamp(0.0, 255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates two squares of side 1 at a right angle to each other, each with its own chart.
    fn corner() -> Mesh {
        let square = |corners: [[f32; 3]; 4], normal: [f32; 3], u: f32| {
            let uvs = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.9], [0.0, 0.9]].map(|[x, y]: [f32; 2]| [x + u, y]);
            (corners, [normal; 4], uvs)
        };
        let floor = square(
            [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            [0.0, 1.0, 0.0],
            0.0,
        );
        let wall = square(
            [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]],
            [1.0, 0.0, 0.0],
            0.5,
        );
        let mut mesh = Mesh::default();
        for (corners, normals, uvs) in [floor, wall] {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners);
            mesh.normals.extend(normals);
            mesh.uvs.extend(uvs);
            mesh.tangents.extend([[0.0, 0.0, 1.0, 1.0]; 4]);
            mesh.triangles
                .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            mesh.triangle_material.extend([0; 2]);
            mesh.triangle_part.extend([0; 2]);
        }
        mesh
    }

    #[test]
    fn a_corner_is_dark_near_the_other_wall_and_open_away_from_it() {
        let mesh = corner();
        let bvh = Bvh::build(&mesh);
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(64)).unwrap();
        let found = Openness::of(&mesh, &atlas, &bvh, None).unwrap();
        assert_eq!(
            Openness::decode(&found.encode(), found.charts.len()),
            Some(found.clone())
        );
        assert_eq!(Openness::decode(&found.encode()[1..], found.charts.len()), None);
        let [left, top, page] = found.charts[atlas.triangle_chart[0] as usize];
        let at = |u: f64, v: f64| {
            let [x, y] = [u, v].map(|at| at * f64::from(found.size));
            let (x, y) = ((x + f64::from(left)) as u32, (y + f64::from(top)) as u32);
            found.texels[((page as u32 * found.page_size[1] + y) * found.page_size[0] + x) as usize]
        };
        // On the floor, v grows along x, away from the wall. Next to the wall, half of the rays hit it.
        let [near, far] = [at(0.2, 0.02), at(0.2, 0.8)];
        assert!((110..200).contains(&near[3]), "{near:?}");
        assert!(far[3] >= 250, "{far:?}");
        assert!(
            near[0] > 150 && far[0].abs_diff(128) < 8,
            "open away from the wall: {near:?}, {far:?}"
        );
    }
}
