//! Width of texels on the surface, and the coarsest size at which an atlas keeps all charts.

use glam::DVec2;
use rayon::prelude::*;

use super::{Atlas, Owner};
use crate::model::Mesh;

/// Number of histogram bins for a factor of two.
const STEPS_A_DOUBLING: f64 = 16.0;
/// Bins of the histogram: widths from 2^-64 to 2^64 times the first one.
const STEPS: usize = 128 * STEPS_A_DOUBLING as usize;
/// Share of the finest texels that is ignored.
const FINER_SHARE: f64 = 0.02;

/// Most levels.
const MOST_LEVELS: u32 = 8;
/// Minimum size of a level, in texels per unit of UV.
const LEAST_SIZE: u32 = 16;
/// Minimum share of the texels that must be in charts that are wide enough for a level.
const WIDE_SHARE: f64 = 0.9;
/// Minimum number of texels of a chart for each texel on its rim. For a strip this is half its width.
const LEAST_HALF_WIDTH: f64 = 1.5;

impl Atlas {
    /// Returns the width of the finest texels in model units: the shorter side of the texels on the surface, ignoring the
    /// finest 2 %, which a model stretches out of proportion. Exact to 5 %; 1 if the surface has no area.
    pub fn finest_texel(&self, mesh: &Mesh) -> f64 {
        let sides: Vec<(f64, f64)> = (0..mesh.triangles.len())
            .into_par_iter()
            .filter_map(|triangle| self.shorter_side(mesh, triangle))
            .collect();
        let Some((unit, _)) = sides.first().copied() else {
            return 1.0;
        };
        let mut texels = vec![0.0_f64; STEPS];
        for (side, area) in &sides {
            let step = (side / unit).log2() * STEPS_A_DOUBLING + (STEPS / 2) as f64;
            texels[step.clamp(0.0, (STEPS - 1) as f64) as usize] += area;
        }
        let wanted = FINER_SHARE * texels.iter().sum::<f64>();
        let mut finer = 0.0;
        let step = texels.iter().position(|area| {
            finer += area;
            finer > wanted
        });
        // If no triangle has an area, the result is the unit.
        let step = step.unwrap_or(STEPS / 2) as f64 - (STEPS / 2) as f64;
        unit * (step / STEPS_A_DOUBLING).exp2()
    }

    /// Returns the shorter side of a triangle's texels in model units, and its area in texels; `None` without area.
    fn shorter_side(&self, mesh: &Mesh, triangle: usize) -> Option<(f64, f64)> {
        let [p0, p1, p2] = mesh.corners(triangle as u32);
        let [q0, q1, q2] = self.triangle_texels[triangle].map(|corner| DVec2::from(corner.map(f64::from)));
        let (q1, q2) = (q1 - q0, q2 - q0);
        let determinant = q1.perp_dot(q2);
        if determinant.abs() < 1e-12 {
            return None;
        }
        let length = |of_1: f64, of_2: f64| ((p1 - p0) * of_1 + (p2 - p0) * of_2).length();
        let along_u = length(q2.y / determinant, -q1.y / determinant);
        let along_v = length(-q2.x / determinant, q1.x / determinant);
        let side = along_u.min(along_v);
        (side.is_finite() && side > 0.0).then_some((side, determinant.abs() / 2.0))
    }

    /// Returns the number of coarser levels, each half as large as the one before, in which nearly all of the surface lies
    /// in charts that are wide enough.
    pub fn usable_levels(&self) -> u32 {
        let rims = self.rim_texels();
        let all: f64 = self.charts.iter().map(|chart| f64::from(chart.texels)).sum();
        let holds = |level: &u32| {
            let least = LEAST_HALF_WIDTH * f64::from(1_u32 << level);
            let wide = self.charts.iter().zip(&rims);
            let wide = wide.filter(|(chart, rim)| f64::from(chart.texels) >= least * f64::from(**rim));
            let texels: f64 = wide.map(|(chart, _)| f64::from(chart.texels)).sum();
            self.size >> level >= LEAST_SIZE && texels >= WIDE_SHARE * all
        };
        (1..=MOST_LEVELS).take_while(holds).count() as u32
    }

    /// Owned texels of each chart that have a neighbor in their row or column which is not owned.
    fn rim_texels(&self) -> Vec<u32> {
        let [width, height] = self.page_size;
        let is_owned = |x: u32, y: u32, page: u32| matches!(self.owner(x, y, page), Owner::Triangle(_));
        let count_row = |row: u32| {
            let (y, page) = (row % height, row / height);
            let mut rims: Vec<u32> = Vec::new();
            for x in 0..width {
                let Owner::Triangle(triangle) = self.owner(x, y, page) else {
                    continue;
                };
                let is_inside = is_owned(x.wrapping_sub(1), y, page)
                    && is_owned(x + 1, y, page)
                    && is_owned(x, y.wrapping_sub(1), page)
                    && is_owned(x, y + 1, page);
                if !is_inside {
                    rims.push(self.triangle_chart[triangle as usize]);
                }
            }
            rims
        };
        let rows: Vec<Vec<u32>> = (0..self.pages * height).into_par_iter().map(count_row).collect();
        let mut rims = vec![0; self.charts.len()];
        for chart in rows.into_iter().flatten() {
            rims[chart as usize] += 1;
        }
        rims
    }
}
