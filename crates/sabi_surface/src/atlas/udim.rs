//! Sheets whose UV tiles are maps of their own, told apart from textures that repeat.

use std::collections::{BTreeMap, BTreeSet};

use super::charts::Partition;
use super::{Udim, charts};
use crate::model::Mesh;

/// Largest part of a tile by which a chart of a UDIM layout may reach into the next one.
const OVERREACH: f32 = 0.01;
/// Least side of charts that are compared, parts of a tile: tiny ones coincide by chance.
const LEAST_SIDE: f32 = 1.0 / 256.0;
/// Steps in a tile to which corners of charts are rounded for comparison.
const STEPS: f32 = 1024.0;

/// Box of a chart's UVs.
struct ChartBox {
    low: [f32; 2],
    high: [f32; 2],
    triangles: usize,
}

/// Shape of a chart, regardless of its tile: corners of its box in steps, and its triangles.
type Shape = ([i32; 4], usize);

/// Returns the sheets of which each UV tile has maps of its own. Without a choice these are the ones that use several tiles
/// and show no sign of a repeating texture: textures of the model that repeat, charts that span tiles, or charts that are
/// congruent modulo 1.
pub(super) fn udim_sheets(mesh: &Mesh, partition: &Partition, udim: Udim) -> BTreeSet<u32> {
    if udim == Udim::Off {
        return BTreeSet::new();
    }
    let mut by_sheet: BTreeMap<u32, Vec<ChartBox>> = BTreeMap::new();
    for chart in 0..partition.len() {
        let triangles = partition.triangles(chart);
        let sheet = charts::sheet_of(mesh, triangles);
        by_sheet.entry(sheet).or_default().push(ChartBox::of(mesh, triangles));
    }
    let is_udim = |sheet: u32, charts: &[ChartBox]| {
        let tiles: BTreeSet<[i32; 2]> = charts.iter().map(ChartBox::tile).collect();
        let repeats =
            || mesh.repeating.contains(&sheet) || charts.iter().any(ChartBox::spans_tiles) || coincide(charts);
        tiles.len() > 1 && (udim == Udim::On || !repeats())
    };
    let sheets = by_sheet.iter().filter(|(sheet, charts)| is_udim(**sheet, charts));
    sheets.map(|(sheet, _)| *sheet).collect()
}

/// Returns true if two charts in different tiles have the same shape there.
fn coincide(charts: &[ChartBox]) -> bool {
    // A corner on the border between two steps may be rounded either way, so there are two sets of steps.
    [0.0, 0.5].into_iter().any(|shift| {
        let mut tile_of_shape: BTreeMap<Shape, [i32; 2]> = BTreeMap::new();
        let large = charts.iter().filter(|chart| chart.least_side() >= LEAST_SIDE);
        let mut placed = large.map(|chart| (chart.shape(shift), chart.tile()));
        placed.any(|(shape, tile)| *tile_of_shape.entry(shape).or_insert(tile) != tile)
    })
}

impl ChartBox {
    fn of(mesh: &Mesh, triangles: &[u32]) -> ChartBox {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for vertex in triangles.iter().flat_map(|triangle| mesh.triangles[*triangle as usize]) {
            let at = mesh.uvs[vertex as usize];
            low = [0, 1].map(|axis| low[axis].min(at[axis]));
            high = [0, 1].map(|axis| high[axis].max(at[axis]));
        }
        let triangles = triangles.len();
        ChartBox { low, high, triangles }
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

    fn shape(&self, shift: f32) -> Shape {
        let tile = self.tile().map(|tile| tile as f32);
        let steps = |at: f32, axis: usize| ((at - tile[axis]) * STEPS + shift).floor() as i32;
        let ([left, top], [right, bottom]) = (self.low, self.high);
        let corners = [steps(left, 0), steps(top, 1), steps(right, 0), steps(bottom, 1)];
        (corners, self.triangles)
    }
}
