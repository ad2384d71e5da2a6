//! Finds sheets whose UV tiles have separate maps, and distinguishes them from textures that repeat.

use std::collections::{BTreeMap, BTreeSet};

use super::charts::Partition;
use super::{AtlasError, Udim, charts};
use crate::model::Mesh;

/// Maximum part of a tile by which a chart of a UDIM layout may extend into the next one.
const OVERREACH: f32 = 0.01;
/// Minimum side of charts that are compared, in tiles: tiny charts coincide by chance.
const LEAST_SIDE: f32 = 1.0 / 256.0;
/// Number of steps in a tile to which corners of charts are rounded for comparison.
const STEPS: f32 = 1024.0;
/// Minimum share of a sheet's UV area that coincides in several tiles if a texture repeats. In a UDIM layout, only a few
/// small parts may be copies at the same place of their tiles.
const REPEATING_SHARE: f64 = 0.5;

/// Returns the UDIM number of a tile, with v counted downward: 1001 is the unit square, +1 to the right, +10 upward. `None`
/// for a tile without a number.
pub fn udim_number([u, v]: [i32; 2]) -> Option<u32> {
    // v grows downward, so the tile above the unit square is −1; numbers of four digits end at row 899.
    ((0..10).contains(&u) && (-899..=0).contains(&v)).then(|| 1001 + u as u32 + 10 * v.unsigned_abs())
}

/// Box of a chart's UVs.
struct ChartBox {
    low: [f32; 2],
    high: [f32; 2],
    triangles: usize,
    /// Sum of the areas of its triangles, in tiles.
    area: f64,
}

/// Shape of a chart, regardless of its tile: corners of its box in steps, and its triangles.
type ChartShape = ([i32; 4], usize);

/// Returns the sheets whose UV tiles have separate maps. If the user has not chosen, these are the sheets that use several
/// tiles and show no sign of a repeating texture: textures of the model that repeat, charts that span tiles, tiles without
/// a UDIM number, or charts that are congruent modulo 1 on much of the sheet.
///
/// # Errors
/// UDIM is asked for and a chart lies in a tile without a number.
pub(super) fn udim_sheets(mesh: &Mesh, partition: &Partition, udim: Udim) -> Result<BTreeSet<u32>, AtlasError> {
    if udim == Udim::Off {
        return Ok(BTreeSet::new());
    }
    let mut by_sheet: BTreeMap<u32, Vec<ChartBox>> = BTreeMap::new();
    for chart in 0..partition.len() {
        let triangles = partition.triangles(chart);
        let of_chart = ChartBox::of(mesh, triangles);
        // A chart without area has no place on the maps.
        if of_chart.area > 0.0 {
            if udim == Udim::On && udim_number(of_chart.tile()).is_none() {
                return Err(of_chart.without_number(triangles[0]));
            }
            let sheet = charts::sheet_of(mesh, triangles);
            by_sheet.entry(sheet).or_default().push(of_chart);
        }
    }
    let is_udim = |sheet: u32, charts: &[ChartBox]| {
        let tiles: BTreeSet<[i32; 2]> = charts.iter().map(ChartBox::tile).collect();
        let repeats = || {
            mesh.repeating.contains(&sheet)
                || tiles.iter().any(|tile| udim_number(*tile).is_none())
                || charts.iter().any(ChartBox::spans_tiles)
                || coinciding_share(charts) >= REPEATING_SHARE
        };
        tiles.len() > 1 && (udim == Udim::On || !repeats())
    };
    let sheets = by_sheet.iter().filter(|(sheet, charts)| is_udim(**sheet, charts));
    Ok(sheets.map(|(sheet, _)| *sheet).collect())
}

/// Returns the share of the charts' area that has the same shape at the same place of another tile.
fn coinciding_share(charts: &[ChartBox]) -> f64 {
    let mut coincide = vec![false; charts.len()];
    // A corner on the border between two steps may be rounded either way, so two sets of steps are tried.
    for shift in [0.0, 0.5] {
        let mut of_shape: BTreeMap<ChartShape, Vec<usize>> = BTreeMap::new();
        for (index, chart) in charts.iter().enumerate() {
            if chart.least_side() >= LEAST_SIDE {
                of_shape.entry(chart.shape(shift)).or_default().push(index);
            }
        }
        for alike in of_shape.into_values() {
            let tile = charts[alike[0]].tile();
            if alike.iter().any(|&index| charts[index].tile() != tile) {
                alike.into_iter().for_each(|index| coincide[index] = true);
            }
        }
    }
    let area = |of: &mut dyn Iterator<Item = &ChartBox>| of.map(|chart| chart.area).sum::<f64>();
    let alike = charts.iter().zip(&coincide).filter(|(_, coincides)| **coincides);
    area(&mut alike.map(|(chart, _)| chart)) / area(&mut charts.iter())
}

impl ChartBox {
    fn of(mesh: &Mesh, triangles: &[u32]) -> ChartBox {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        let area = triangles.iter().map(|triangle| mesh.uv_area(*triangle)).sum();
        for vertex in triangles.iter().flat_map(|triangle| mesh.triangles[*triangle as usize]) {
            let at = mesh.uvs[vertex as usize];
            low = [0, 1].map(|axis| low[axis].min(at[axis]));
            high = [0, 1].map(|axis| high[axis].max(at[axis]));
        }
        let triangles = triangles.len();
        ChartBox {
            low,
            high,
            triangles,
            area,
        }
    }

    /// Error about a chart outside of the tiles that have UDIM numbers.
    fn without_number(&self, triangle: u32) -> AtlasError {
        let [u, v] = self.tile();
        // Programs that show UV tiles count v upward.
        AtlasError::NoUdimNumber { triangle, u, v: -v }
    }

    /// Tile of the middle.
    fn tile(&self) -> [i32; 2] {
        [0, 1].map(|axis| ((self.low[axis] + self.high[axis]) / 2.0).floor() as i32)
    }

    fn spans_tiles(&self) -> bool {
        let tile = self.tile().map(|tile| tile as f32);
        (0..2).any(|axis| self.low[axis] < tile[axis] - OVERREACH || self.high[axis] > tile[axis] + 1.0 + OVERREACH)
    }

    fn least_side(&self) -> f32 {
        (self.high[0] - self.low[0]).min(self.high[1] - self.low[1])
    }

    fn shape(&self, shift: f32) -> ChartShape {
        let tile = self.tile().map(|tile| tile as f32);
        let steps = |at: f32, axis: usize| ((at - tile[axis]) * STEPS + shift).floor() as i32;
        let ([left, top], [right, bottom]) = (self.low, self.high);
        let corners = [steps(left, 0), steps(top, 1), steps(right, 0), steps(bottom, 1)];
        (corners, self.triangles)
    }
}
