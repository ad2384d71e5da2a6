//! Coarser levels: separately packed atlases of the same charts.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{Atlas, AtlasError, Owner};
use crate::model::Mesh;

/// Page size that every adapter supports.
const PAGE_LIMIT: u32 = 8192;

/// Maximum number of steps from texel to texel, over the surface, from a texel without a counterpart to one that has a counterpart.
const REACH: u32 = 64;

/// Coarser atlas and the correspondence between its texels and those of the atlas it was made for.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasLevel {
    /// The coarser atlas: its charts have the same numbers.
    pub atlas: Atlas,
    /// Owned texels of the coarser atlas that cover no center of a finer texel, such as those of slivers.
    pub coarse_orphans: Vec<Orphan>,
    /// Owned texels of the finer atlas that have no texel of their chart nearby on the coarser atlas.
    pub fine_orphans: Vec<Orphan>,
    fine_size: u32,
    fine_offsets: Vec<[i32; 2]>,
}

/// A texel without a counterpart on another level, and the nearest texel on the surface that has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orphan {
    /// Column, row, page.
    pub texel: [u32; 3],
    /// Column, row, page of an owned texel of the same atlas.
    pub from: [u32; 3],
}

impl Atlas {
    /// Builds the atlas of the same charts at `size >> level`, packed with full gaps and rings.
    pub fn level(&self, mesh: &Mesh, level: u32) -> Result<AtlasLevel, AtlasError> {
        // Shifting out all bits gives 0, which is an error below.
        let level_size = self.size.checked_shr(level).unwrap_or(0);
        if level_size < 8 {
            return Err(AtlasError::LevelTooSmall {
                level,
                size: self.size,
                level_size,
            });
        }
        let page_limit = self.page_size.into_iter().fold(PAGE_LIMIT, u32::max);
        let atlas = self.rebuild(mesh, level_size, page_limit)?;
        let fine_offsets = self.charts.iter().map(|chart| chart.texel_from_uv).collect();
        let mut made = AtlasLevel {
            atlas,
            coarse_orphans: Vec::new(),
            fine_orphans: Vec::new(),
            fine_size: self.size,
            fine_offsets,
        };
        made.coarse_orphans = made
            .atlas
            .orphans(|chart, texel| made.covers_a_finer(self, chart, texel));
        made.fine_orphans = self.orphans(|chart, texel| made.has_a_coarser(chart, texel));
        Ok(made)
    }

    /// Returns the owned texels for which `has_counterpart(chart, texel)` is false, each with the nearest texel that has a
    /// counterpart. Texels that are too far from such a texel are left out.
    fn orphans(&self, has_counterpart: impl Fn(u32, [u32; 3]) -> bool + Sync) -> Vec<Orphan> {
        let [width, height] = self.page_size;
        let rows = (0..self.pages * height).into_par_iter();
        let unmatched: Vec<[u32; 3]> = rows
            .flat_map_iter(|row| (0..width).map(move |x| [x, row % height, row / height]))
            .filter(|texel| match self.owner(texel[0], texel[1], texel[2]) {
                Owner::Triangle(triangle) => !has_counterpart(self.triangle_chart[triangle as usize], *texel),
                _ => false,
            })
            .collect();
        let mut found: BTreeMap<[u32; 3], Option<[u32; 3]>> = unmatched.iter().map(|texel| (*texel, None)).collect();
        for _ in 0..REACH {
            let open = found.iter().filter(|(_, from)| from.is_none()).map(|(texel, _)| *texel);
            let news: Vec<_> = open
                .filter_map(|texel| Some((texel, self.known_beside(texel, &found)?)))
                .collect();
            if news.is_empty() {
                break;
            }
            found.extend(news.into_iter().map(|(texel, from)| (texel, Some(from))));
        }
        let orphan = |(texel, from): ([u32; 3], Option<[u32; 3]>)| from.map(|from| Orphan { texel, from });
        found.into_iter().filter_map(orphan).collect()
    }

    /// Returns the texel whose counterpart a neighbor uses: the neighbor itself, or the texel that was found for the neighbor.
    fn known_beside(&self, texel: [u32; 3], found: &BTreeMap<[u32; 3], Option<[u32; 3]>>) -> Option<[u32; 3]> {
        const NEIGHBORS: [[i32; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];
        NEIGHBORS.into_iter().find_map(|[x, y]| {
            let [column, row] = [texel[0].checked_add_signed(x)?, texel[1].checked_add_signed(y)?];
            let near = match self.owner(column, row, texel[2]) {
                Owner::Triangle(_) => [column, row, texel[2]],
                Owner::Ghost(index) => {
                    let ghost = &self.ghosts[index as usize];
                    let [u, v] = ghost.read_texel.map(|value| value.max(0.0) as u32);
                    let chart = self.triangle_chart[ghost.read_triangle as usize] as usize;
                    let page = self.charts[chart].page;
                    matches!(self.owner(u, v, page), Owner::Triangle(_)).then_some([u, v, page])?
                }
                Owner::Empty => return None,
            };
            match found.get(&near) {
                None => Some(near),
                Some(known) => *known,
            }
        })
    }
}

impl AtlasLevel {
    /// Maps a point of the finer atlas to this level, through UV: texel coordinates on the chart's page. Panics if there is no such chart.
    pub fn coarse_texel_from_fine(&self, chart: u32, texel: [f64; 2]) -> [f64; 2] {
        let scale = f64::from(self.atlas.size) / f64::from(self.fine_size);
        let (fine, coarse) = self.offsets(chart);
        [0, 1].map(|axis| (texel[axis] - fine[axis]) * scale + coarse[axis])
    }

    /// Maps a point of this level to the finer atlas, through UV: texel coordinates on the chart's page. Panics if there is no such chart.
    pub fn fine_texel_from_coarse(&self, chart: u32, texel: [f64; 2]) -> [f64; 2] {
        let scale = f64::from(self.fine_size) / f64::from(self.atlas.size);
        let (fine, coarse) = self.offsets(chart);
        [0, 1].map(|axis| (texel[axis] - coarse[axis]) * scale + fine[axis])
    }

    /// Returns the number of finer texels along a side of a coarser texel.
    pub fn factor(&self) -> u32 {
        self.fine_size / self.atlas.size
    }

    /// Returns whether a texel of this level covers a finer texel of its chart, by the same rule as `restrict.wgsl`.
    fn covers_a_finer(&self, fine: &Atlas, chart: u32, texel: [u32; 3]) -> bool {
        let corner = self.fine_texel_from_coarse(chart, [f64::from(texel[0]), f64::from(texel[1])]);
        let page = fine.charts[chart as usize].page;
        let factor = i64::from(self.factor());
        (0..factor * factor).any(|index| {
            let (x, y) = (corner[0] as i64 + index % factor, corner[1] as i64 + index / factor);
            let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
                return false;
            };
            matches!(fine.owner(x, y, page), Owner::Triangle(triangle) if fine.triangle_chart[triangle as usize] == chart)
        })
    }

    /// Returns whether one of the four texels of this level around a finer texel belongs to its chart, by the same rule as `prolong.wgsl`.
    fn has_a_coarser(&self, chart: u32, texel: [u32; 3]) -> bool {
        let center = [f64::from(texel[0]) + 0.5, f64::from(texel[1]) + 0.5];
        let corner = self
            .coarse_texel_from_fine(chart, center)
            .map(|value| (value - 0.5).floor() as i64);
        let page = self.atlas.charts[chart as usize].page;
        [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().any(|[x, y]| {
            let (Ok(x), Ok(y)) = (u32::try_from(corner[0] + x), u32::try_from(corner[1] + y)) else {
                return false;
            };
            match self.atlas.owner(x, y, page) {
                Owner::Triangle(triangle) => self.atlas.triangle_chart[triangle as usize] == chart,
                Owner::Ghost(index) => self.atlas.ghosts[index as usize].chart == chart,
                Owner::Empty => false,
            }
        })
    }

    fn offsets(&self, chart: u32) -> ([f64; 2], [f64; 2]) {
        let coarse = self.atlas.charts[chart as usize].texel_from_uv;
        (self.fine_offsets[chart as usize].map(f64::from), coarse.map(f64::from))
    }
}
