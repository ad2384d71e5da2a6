//! The owned texels of an atlas as a graph: position and size of each texel, and its neighbors.

use glam::DVec3;
use rayon::prelude::*;

use super::Lists;
use crate::atlas::{Atlas, EMPTY, GHOST_BIT, Ghost, Owner};
use crate::model::Mesh;

/// Offsets to neighboring texels; first those that share a side.
const STEPS: [[i32; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];

/// Maximum distance between a ghost and its reflection in the border of the surface, in texels.
const TURNED_BACK: f32 = 2.5;

/// An owned texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texel {
    /// Its index in [`Atlas::owners`].
    pub(super) index: u32,
    /// Point of the surface under its center, model units.
    pub(super) position: DVec3,
    /// Area of the surface under it, along the normal of its face; square model units.
    pub(super) area: DVec3,
    /// True if the surface ends beside it.
    pub(super) is_at_border: bool,
}

/// Texels that own a part of the surface, and the neighbors of each, also across seams.
pub(super) struct TexelGraph {
    pub(super) texels: Vec<Texel>,
    pub(super) neighbors: Lists<u32>,
}

/// Plane of a triangle over the texels of its chart: a point, and the steps for a texel along u and v.
struct TrianglePlane {
    origin: DVec3,
    texel: [f64; 2],
    steps: [DVec3; 2],
    area: DVec3,
}

impl TexelGraph {
    pub(super) fn new(mesh: &Mesh, atlas: &Atlas) -> TexelGraph {
        let planes: Vec<TrianglePlane> = (0..mesh.triangles.len())
            .into_par_iter()
            .map(|triangle| TrianglePlane::of(mesh, atlas, triangle))
            .collect();
        let [width, height] = atlas.page_size.map(|side| side as usize);
        let owned = atlas
            .owners
            .iter()
            .enumerate()
            .filter(|(_, owner)| **owner & GHOST_BIT == 0);
        let texels: Vec<Texel> = owned
            .map(|(index, triangle)| {
                let plane = &planes[*triangle as usize];
                let center = [(index % width) as f64 + 0.5, (index / width % height) as f64 + 0.5];
                let [u, v] = [0, 1].map(|axis| center[axis] - plane.texel[axis]);
                Texel {
                    index: index as u32,
                    position: plane.origin + plane.steps[0] * u + plane.steps[1] * v,
                    area: plane.area,
                    is_at_border: is_at_border(atlas, index as u32),
                }
            })
            .collect();
        let mut numbers = vec![EMPTY; atlas.owners.len()];
        for (number, texel) in texels.iter().enumerate() {
            numbers[texel.index as usize] = number as u32;
        }
        let mut neighbors: Vec<Vec<u32>> = texels
            .par_iter()
            .map(|texel| {
                let near = STEPS.iter().filter_map(|step| neighbor(atlas, texel.index, *step));
                near.map(|index| numbers[index]).collect()
            })
            .collect();
        add_ways_back(&mut neighbors);
        TexelGraph {
            texels,
            neighbors: Lists::new(neighbors),
        }
    }
}

/// Makes neighborhood mutual: a link across a seam may lead in only one direction, but neighbors must be reachable from both sides.
fn add_ways_back(neighbors: &mut [Vec<u32>]) {
    let one_way: Vec<(u32, u32)> = neighbors
        .par_iter()
        .zip(0..neighbors.len() as u32)
        .flat_map_iter(|(near, texel)| near.iter().map(move |other| (*other, texel)))
        .filter(|(other, texel)| !neighbors[*other as usize].contains(texel))
        .collect();
    for (other, texel) in one_way {
        neighbors[other as usize].push(texel);
    }
}

/// Returns the content of the texel at an offset from a texel.
fn beside(atlas: &Atlas, index: u32, [right, down]: [i32; 2]) -> ([u32; 3], Owner) {
    let [width, height] = atlas.page_size;
    let page = index / (width * height);
    let x = (index % width).saturating_add_signed(right);
    let y = (index / width % height).saturating_add_signed(down);
    ([x, y, page], atlas.owner(x, y, page))
}

/// Returns the index of the owned texel at an offset from an owned texel, also across a seam.
fn neighbor(atlas: &Atlas, index: u32, step: [i32; 2]) -> Option<usize> {
    let index_of = |[x, y, page]: [u32; 3]| {
        let [width, height] = atlas.page_size;
        ((page * height + y) * width + x) as usize
    };
    match beside(atlas, index, step) {
        (texel, Owner::Triangle(_)) => Some(index_of(texel)),
        (_, Owner::Ghost(ghost)) => owned_near(atlas, &atlas.ghosts[ghost as usize]).map(index_of),
        (_, Owner::Empty) => None,
    }
}

/// The owned texel nearest to the place that a ghost reads, of those that touch it.
fn owned_near(atlas: &Atlas, ghost: &Ghost) -> Option<[u32; 3]> {
    let [u, v] = ghost.read_texel.map(f64::from);
    let page = atlas.charts[atlas.triangle_chart[ghost.read_triangle as usize] as usize].page;
    let around = [[0, 0]].into_iter().chain(STEPS);
    let owned = around.filter_map(|[right, down]| {
        let x = (u.max(0.0) as u32).checked_add_signed(right)?;
        let y = (v.max(0.0) as u32).checked_add_signed(down)?;
        let is_owned = matches!(atlas.owner(x, y, page), Owner::Triangle(_));
        let away = (f64::from(x) + 0.5 - u).hypot(f64::from(y) + 0.5 - v);
        is_owned.then_some((away, [x, y, page]))
    });
    owned.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, texel)| texel)
}

/// Returns whether the surface ends beside an owned texel. Walks are mirrored there, so the ghost continues the chart itself.
fn is_at_border(atlas: &Atlas, index: u32) -> bool {
    STEPS[..4].iter().any(|step| match beside(atlas, index, *step) {
        (_, Owner::Triangle(_)) => false,
        (_, Owner::Empty) => true,
        ([x, y, _], Owner::Ghost(ghost)) => {
            let ghost = &atlas.ghosts[ghost as usize];
            let [u, v] = ghost.target_texel;
            let away = (x as f32 + 0.5 - u).hypot(y as f32 + 0.5 - v);
            atlas.triangle_chart[ghost.target_triangle as usize] == ghost.chart && away < TURNED_BACK
        }
    })
}

impl TrianglePlane {
    fn of(mesh: &Mesh, atlas: &Atlas, triangle: usize) -> TrianglePlane {
        let corners = mesh.triangles[triangle].map(|vertex| vertex as usize);
        let position = corners.map(|corner| glam::Vec3::from(mesh.positions[corner]).as_dvec3());
        // Differences of UVs are used, since corners on the page are rounded.
        let uv = corners.map(|corner| mesh.uvs[corner].map(|value| f64::from(value) * f64::from(atlas.size)));
        let [a, b, c, d] = [[1, 0], [1, 1], [2, 0], [2, 1]].map(|[to, axis]: [usize; 2]| uv[to][axis] - uv[0][axis]);
        let determinant = a * d - b * c;
        let [first, second] = [position[1] - position[0], position[2] - position[0]];
        let steps = if determinant.abs() < 1e-12 {
            [DVec3::ZERO; 2]
        } else {
            [
                (first * d - second * b) / determinant,
                (second * a - first * c) / determinant,
            ]
        };
        let face = first.cross(second).normalize_or_zero();
        TrianglePlane {
            origin: position[0],
            texel: atlas.triangle_texels[triangle][0].map(f64::from),
            steps,
            area: face * steps[0].cross(steps[1]).length(),
        }
    }
}
