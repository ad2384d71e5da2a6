//! Bilinear sampling of heights on the texels of an atlas.

use crate::atlas::{Atlas, Owner};

/// Heights of all texels of an atlas, ghosts included.
#[derive(Clone, Copy)]
pub struct HeightPlane<'a> {
    atlas: &'a Atlas,
    heights: &'a [f32],
}

impl<'a> HeightPlane<'a> {
    /// Creates a plane from heights in model units, page by page and row by row. Ghosts must be filled. Texels that belong
    /// to nothing may have any value, and missing texels count as such.
    pub fn new(atlas: &'a Atlas, heights: &'a [f32]) -> HeightPlane<'a> {
        HeightPlane { atlas, heights }
    }

    /// Returns the height at a place of a chart, given in texels of its page, by bilinear interpolation. Only texels of the
    /// chart and of its ring are used, so that neighboring charts on the page have no effect. `None` if there are no such
    /// texels, as for charts too thin to own a texel.
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

    /// Returns the height of a texel if it belongs to the chart or its ring; 0 for heights that are not finite.
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
