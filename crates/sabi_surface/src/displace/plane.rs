//! Bilinear sampling of heights on the texels of an atlas.

use crate::atlas::{Atlas, Owner};

/// Heights for each texel of an atlas, ghosts included.
#[derive(Clone, Copy)]
pub struct HeightPlane<'a> {
    atlas: &'a Atlas,
    heights: &'a [f32],
}

impl<'a> HeightPlane<'a> {
    /// Heights in model units, page by page and row by row. Ghosts have to be filled; texels that nothing owns may hold
    /// anything, and texels that are missing count as those.
    pub fn new(atlas: &'a Atlas, heights: &'a [f32]) -> HeightPlane<'a> {
        HeightPlane { atlas, heights }
    }

    /// The height at a place of a chart in texels of its page, bilinear. Only texels of the chart and of its ring count, so
    /// that no neighbor on the page bleeds in; `None` where there are none, as on charts too thin to own a texel.
    pub fn at(&self, chart: u32, texel: [f32; 2]) -> Option<f32> {
        let page = self.atlas.charts.get(chart as usize)?.page;
        let low = texel.map(|at| (at - 0.5).floor());
        let part = [0, 1].map(|axis| f64::from(texel[axis] - 0.5 - low[axis]));
        let (mut sum, mut weights) = (0.0, 0.0);
        for corner in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let weight: f64 = (0..2)
                .map(|axis| {
                    if corner[axis] == 0 {
                        1.0 - part[axis]
                    } else {
                        part[axis]
                    }
                })
                .product();
            let [x, y] = [0, 1].map(|axis| low[axis] + corner[axis] as f32);
            if weight > 0.0
                && x >= 0.0
                && y >= 0.0
                && let Some(height) = self.of_chart(chart, [x as u32, y as u32], page)
            {
                sum += weight * f64::from(height);
                weights += weight;
            }
        }
        (weights > 0.0).then(|| (sum / weights) as f32)
    }

    /// The height of a texel if it is the chart's or of the chart's ring; 0 for what is not finite.
    fn of_chart(&self, chart: u32, [x, y]: [u32; 2], page: u32) -> Option<f32> {
        let owner = match self.atlas.owner(x, y, page) {
            Owner::Empty => None,
            Owner::Triangle(triangle) => self.atlas.triangle_chart.get(triangle as usize).copied(),
            Owner::Ghost(ghost) => self.atlas.ghosts.get(ghost as usize).map(|ghost| ghost.chart),
        };
        if owner != Some(chart) {
            return None;
        }
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let row = page as usize * height + y as usize;
        let value = *self.heights.get(row * width + x as usize)?;
        Some(if value.is_finite() { value } else { 0.0 })
    }
}
