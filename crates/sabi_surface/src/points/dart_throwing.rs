//! Points spread by dart throwing along the surface, and the cells of texels around them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::texels::{Texel, TexelGraph};
use super::{CellTexel, Lists, SurfacePoint};
use crate::atlas::EMPTY;

/// Number of times that points are moved to the centers of their cells.
const MOVES: usize = 2;

/// Cells of texels around points.
pub(super) struct Cells {
    /// Center of each cell.
    pub(super) centers: Vec<DVec3>,
    /// Area of each cell along its mean normal, square model units.
    pub(super) areas: Vec<DVec3>,
    /// Area of each cell, square model units.
    pub(super) sizes: Vec<f64>,
    /// The texel of the graph nearest to each center.
    pub(super) middles: Vec<u32>,
    /// The point of each texel of the graph.
    pub(super) point_of_texel: Vec<u32>,
}

/// Spreads points at least a spacing apart, and finds their cells.
pub(super) fn cells(graph: &TexelGraph, spacing: f64) -> Cells {
    let mut cells = Cells::of(graph, &darts(graph, spacing));
    for _ in 0..MOVES {
        cells = Cells::of(graph, &cells.middles);
    }
    cells
}

/// Returns texels that are at least a spacing apart along the surface, such that no more can be added.
fn darts(graph: &TexelGraph, spacing: f64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..graph.texels.len() as u32).collect();
    order.sort_by_key(|texel| (shuffled(*texel), *texel));
    // For each texel, the last dart whose reach contains it.
    let mut reached = vec![EMPTY; graph.texels.len()];
    let mut darts = Vec::new();
    let mut open = Vec::new();
    for dart in order {
        if reached[dart as usize] != EMPTY {
            continue;
        }
        darts.push(dart);
        let center = graph.texels[dart as usize].position;
        reached[dart as usize] = dart;
        open.push(dart);
        while let Some(texel) = open.pop() {
            for near in graph.neighbors.of(texel as usize) {
                let away = graph.texels[*near as usize].position.distance_squared(center);
                if reached[*near as usize] != dart && away < spacing * spacing {
                    reached[*near as usize] = dart;
                    open.push(*near);
                }
            }
        }
    }
    // Sort in the order of the texels, so that neighbors are near each other in memory.
    darts.sort_unstable();
    darts
}

/// Returns a pseudo-random number (PCG).
fn shuffled(number: u32) -> u32 {
    let state = number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

impl Cells {
    /// Assigns each texel to the nearest seed, with cells that grow along the surface.
    fn of(graph: &TexelGraph, seeds: &[u32]) -> Cells {
        let point_of_texel = grown(graph, seeds);
        let mut sums = vec![DVec3::ZERO; seeds.len()];
        let mut areas = vec![DVec3::ZERO; seeds.len()];
        let mut sizes = vec![0.0; seeds.len()];
        for (texel, point) in graph.texels.iter().zip(&point_of_texel) {
            let at = *point as usize;
            let size = texel_size(texel.area);
            sums[at] += texel.position * size;
            areas[at] += texel.area;
            sizes[at] += size;
        }
        let centers: Vec<DVec3> = sums.iter().zip(&sizes).map(|(sum, size)| *sum / *size).collect();
        let mut middles = seeds.to_vec();
        let mut least = vec![f64::INFINITY; seeds.len()];
        for (number, (texel, point)) in graph.texels.iter().zip(&point_of_texel).enumerate() {
            let at = *point as usize;
            let away = texel.position.distance_squared(centers[at]);
            if away < least[at] {
                least[at] = away;
                middles[at] = number as u32;
            }
        }
        Cells {
            centers,
            areas,
            sizes,
            middles,
            point_of_texel,
        }
    }

    /// The points, for [`super::SurfacePoints`].
    pub(super) fn points(&self, graph: &TexelGraph) -> Vec<SurfacePoint> {
        let point = |point: usize| {
            let texel = &graph.texels[self.middles[point] as usize];
            let face = texel.area.normalize_or(DVec3::Y);
            let normal = self.areas[point].normalize_or(face);
            let (right, ahead) = normal.any_orthonormal_pair();
            SurfacePoint {
                position: self.centers[point].as_vec3().to_array(),
                normal: normal.as_vec3().to_array(),
                axes: [ahead, right].map(|axis| axis.as_vec3().to_array()),
                area: self.sizes[point],
                texel: texel.index,
            }
        };
        (0..self.centers.len()).map(point).collect()
    }

    /// Numbers of the texels of each cell.
    pub(super) fn members(&self) -> Lists<u32> {
        let mut lists = vec![Vec::new(); self.centers.len()];
        for (texel, point) in (0..).zip(&self.point_of_texel) {
            lists[*point as usize].push(texel);
        }
        Lists::new(lists)
    }

    /// Texels of each cell with their shares, for [`super::SurfacePoints`].
    pub(super) fn texels(&self, graph: &TexelGraph, members: &Lists<u32>) -> Lists<CellTexel> {
        let share = |texel: &u32| {
            let Texel { index, area, .. } = graph.texels[*texel as usize];
            let cell = self.sizes[self.point_of_texel[*texel as usize] as usize];
            CellTexel {
                texel: index,
                share: (texel_size(area) / cell) as f32,
            }
        };
        Lists {
            starts: members.starts.clone(),
            entries: members.entries.iter().map(share).collect(),
        }
    }
}

/// Returns the area of a texel. A texel on a triangle without area gets a small one, so that every texel counts.
fn texel_size(area: DVec3) -> f64 {
    area.length().max(f64::MIN_POSITIVE.sqrt())
}

/// Returns the seed of each texel: the one that reaches it first, ordered by straight distance to the seed.
fn grown(graph: &TexelGraph, seeds: &[u32]) -> Vec<u32> {
    let mut point_of_texel = vec![EMPTY; graph.texels.len()];
    // For each texel the nearest seed so far, by distance and number: farther ones need not be queued.
    let mut least = vec![(u64::MAX, EMPTY); graph.texels.len()];
    let mut open: BinaryHeap<Reverse<(u64, u32, u32)>> = seeds
        .iter()
        .enumerate()
        .map(|(point, seed)| Reverse((0, *seed, point as u32)))
        .collect();
    while let Some(Reverse((_, texel, point))) = open.pop() {
        if point_of_texel[texel as usize] != EMPTY {
            continue;
        }
        point_of_texel[texel as usize] = point;
        let center = graph.texels[seeds[point as usize] as usize].position;
        for near in graph.neighbors.of(texel as usize) {
            if point_of_texel[*near as usize] == EMPTY {
                let away = graph.texels[*near as usize].position.distance_squared(center);
                // The bits of non-negative floats are in the same order as the floats.
                let seen = (away.to_bits(), point);
                if seen < least[*near as usize] {
                    least[*near as usize] = seen;
                    open.push(Reverse((seen.0, *near, point)));
                }
            }
        }
    }
    point_of_texel
}
