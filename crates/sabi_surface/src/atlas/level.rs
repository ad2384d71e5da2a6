//! Coarser levels: atlases of their own, packed anew, that know the same charts.

use super::{Atlas, AtlasError};
use crate::model::Mesh;

/// Pages of any adapter.
const PAGE_LIMIT: u32 = 8192;

/// A coarser atlas and the way between its texels and those of the atlas it was made for.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasLevel {
    /// The coarser atlas: its charts have the same numbers.
    pub atlas: Atlas,
    fine_size: u32,
    fine_offsets: Vec<[i32; 2]>,
}

impl Atlas {
    /// The atlas of the same charts at `size >> level`, packed anew with full gaps and rings.
    pub fn level(&self, mesh: &Mesh, level: u32) -> Result<AtlasLevel, AtlasError> {
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
        Ok(AtlasLevel {
            atlas,
            fine_size: self.size,
            fine_offsets,
        })
    }
}

impl AtlasLevel {
    /// Where a point of the finer atlas lies on this level: texel coordinates on the chart's page, by way of UV.
    /// Panics when there is no such chart.
    pub fn coarse_texel_from_fine(&self, chart: u32, texel: [f64; 2]) -> [f64; 2] {
        let scale = f64::from(self.atlas.size) / f64::from(self.fine_size);
        let (fine, coarse) = self.offsets(chart);
        [0, 1].map(|axis| (texel[axis] - fine[axis]) * scale + coarse[axis])
    }

    /// Where a point of this level lies on the finer atlas: texel coordinates on the chart's page, by way of UV.
    /// Panics when there is no such chart.
    pub fn fine_texel_from_coarse(&self, chart: u32, texel: [f64; 2]) -> [f64; 2] {
        let scale = f64::from(self.fine_size) / f64::from(self.atlas.size);
        let (fine, coarse) = self.offsets(chart);
        [0, 1].map(|axis| (texel[axis] - coarse[axis]) * scale + fine[axis])
    }

    fn offsets(&self, chart: u32) -> ([f64; 2], [f64; 2]) {
        let coarse = self.atlas.charts[chart as usize].texel_from_uv;
        (self.fine_offsets[chart as usize].map(f64::from), coarse.map(f64::from))
    }
}
