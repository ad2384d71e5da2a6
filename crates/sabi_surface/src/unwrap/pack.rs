//! Packing of all charts on one sheet, at one scale, as large as they fit.

use glam::DVec2;
use rayon::prelude::*;
use sabi_cancel::look;

use super::area::{area, flat_area};
use super::flatten::FlatChart;
use super::{GAP, UnwrapError, UnwrapLayout, UnwrapReport};
use crate::atlas::fixed_point_uvs::UNIT;
use crate::atlas::mask::Mask;
use crate::atlas::pack::Packer;
use crate::atlas::raster::spans;
use crate::model::Mesh;

/// Cells along a side of the sheet while charts are packed, and for more than [`MANY`] charts.
const CELLS: [u32; 2] = [512, 4096];
/// Number of charts above which the finer cells are used.
const MANY: usize = 10_000;
/// Bisection steps of the scale: to 1/2⁷ of the range between a scale that fits and one that does not.
const STEPS: u32 = 7;
/// Share of the sheet that no packing reaches.
const TOO_FULL: f64 = 0.95;
/// Maximum number of texels in the bounding boxes of all charts, at one bit each: 256 MB.
const MOST_BOXED: f64 = (1u64 << 27) as f64;

/// Two corners of a triangle, model units.
type BorderEdge = [DVec2; 2];

/// A chart to be packed.
struct ChartOutline<'a> {
    chart: &'a FlatChart,
    /// Lower corner of its bounding box, model units.
    origin: DVec2,
    /// Width and height, model units.
    side: DVec2,
    /// Border edges.
    outline: Vec<BorderEdge>,
}

impl ChartOutline<'_> {
    fn new(chart: &FlatChart) -> ChartOutline<'_> {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &corner in chart.corners.iter().flatten() {
            (low, high) = (low.min(corner), high.max(corner));
        }
        let edges = chart.corners.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut keyed: Vec<([[u64; 2]; 2], BorderEdge)> = edges
            .map(|[a, b]| {
                let mut key = [a, b].map(|corner| corner.to_array().map(f64::to_bits));
                key.sort_unstable();
                (key, [a, b])
            })
            .collect();
        keyed.sort_unstable_by_key(|(key, _)| *key);
        let outline = keyed.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() == 1);
        ChartOutline {
            chart,
            origin: low,
            side: high - low,
            outline: outline.map(|group| group[0].1).collect(),
        }
    }

    /// Returns a corner in texels, relative to the lower corner of the bounding box.
    fn texel(&self, corner: DVec2, scale: f64) -> DVec2 {
        (corner - self.origin) * scale
    }

    /// Returns the width and height of the shape at a scale, in whole texels.
    fn texels(&self, scale: f64) -> [u32; 2] {
        (self.side * scale).floor().as_uvec2().to_array().map(|side| side + 1)
    }

    /// Returns a corner like [`ChartOutline::texel`], after quarter turns like those of [`Mask::turned`].
    fn turned_texel(&self, corner: DVec2, scale: f64, turns: u32) -> DVec2 {
        let DVec2 { x, y } = self.texel(corner, scale);
        let [width, height] = self.texels(scale).map(f64::from);
        match turns {
            0 => DVec2::new(x, y),
            1 => DVec2::new(y, width - x),
            2 => DVec2::new(width - x, height - y),
            _ => DVec2::new(height - y, x),
        }
    }

    /// Returns the texels that the shape touches at a scale, grown by half the gap on all sides.
    fn mask(&self, scale: f64) -> Mask {
        let [width, height] = self.texels(scale);
        let mut mask = Mask::empty([0, 0], width, height);
        for triangle in &self.chart.corners {
            let corners = triangle.map(|corner| self.texel(corner, scale));
            let fixed = corners.map(|corner| (corner * UNIT as f64).round().as_i64vec2().to_array());
            spans(fixed, 0..i64::from(height), |y, x0, x1| {
                mask.set(y, x0.max(0), x1.min(i64::from(width)));
            });
        }
        // Texel centers alone would miss thin parts, so all texels along the outline are set, too.
        for edge in &self.outline {
            let [from, to] = edge.map(|corner| self.texel(corner, scale));
            let steps = (2.0 * (to - from).abs().max_element()).ceil() as u32 + 1;
            for step in 0..=steps {
                let t = f64::from(step) / f64::from(steps);
                let at = (from + (to - from) * t).as_uvec2();
                let (x, y) = (at.x.min(width - 1), at.y.min(height - 1));
                mask.set(i64::from(y), i64::from(x), i64::from(x) + 1);
            }
        }
        mask.grown()
    }
}

/// Placement of all charts on the sheet.
struct SheetPacking {
    /// Texels per model unit.
    scale: f64,
    /// Side of the sheet for which it was packed, in texels.
    size: u32,
    /// Quarter turns of each chart, and the lower corner of its bounding box after them, texels.
    places: Vec<(u32, DVec2)>,
}

/// Packs charts as large as they fit, with [`GAP`] texels between them, on a sheet of `size` texels. If there are too many
/// charts, the sheet has more texels, up to `finest`, so that gaps are narrower.
pub(super) fn pack(mesh: &Mesh, charts: &[FlatChart], [size, finest]: [u32; 2]) -> Result<UnwrapLayout, UnwrapError> {
    let shapes: Vec<ChartOutline> = charts.par_iter().map(ChartOutline::new).collect();
    let total: f64 = charts
        .iter()
        .flat_map(|chart| &chart.corners)
        .map(|&corners| flat_area(corners))
        .sum();
    let mut packed_size = size;
    let packing = loop {
        match largest(&shapes, total, packed_size) {
            Some(packing) => break packing,
            None if packed_size < finest => packed_size *= 2,
            None => {
                return Err(UnwrapError::TooManyCharts { charts: charts.len() });
            }
        }
    };
    let mut corners = vec![[[0.0f32; 2]; 3]; mesh.triangles.len()];
    let side = f64::from(packing.size);
    for (shape, (turns, at)) in shapes.iter().zip(&packing.places) {
        for (&triangle, flat) in shape.chart.triangles.iter().zip(&shape.chart.corners) {
            corners[triangle as usize] = flat.map(|corner| {
                let texel = shape.turned_texel(corner, packing.scale, *turns);
                ((texel + at) / side).as_vec2().to_array()
            });
        }
    }
    let mut report = UnwrapReport {
        charts: charts.len() as u32,
        coverage: (total * packing.scale.powi(2) / side.powi(2)) as f32,
        gap: GAP as f32 * size as f32 / packing.size as f32,
        ..UnwrapReport::default()
    };
    (report.stretch, report.worst_stretch) = stretch(mesh, charts);
    report.warnings = warnings(mesh, charts, &report, size);
    Ok(UnwrapLayout { corners, report })
}

/// Returns the packing at the largest scale found by bisection; `None` when none fits.
fn largest(shapes: &[ChartOutline], total: f64, size: u32) -> Option<SheetPacking> {
    // Even a point takes a texel and the gap around it.
    let (cell, limit) = cells(shapes.len(), size);
    let least = u64::from((1 + GAP).div_ceil(cell)).pow(2);
    if shapes.len() as u64 * least > u64::from(limit).pow(2) {
        return None;
    }
    let ceiling = f64::from(size) * (TOO_FULL / total.max(f64::MIN_POSITIVE)).sqrt();
    let mut best = None;
    let (mut low, mut high) = (0.0, 1.0);
    for step in 0..STEPS {
        // Most layouts fill half to three quarters of the sheet.
        let share = if step == 0 { 0.7 } else { (low + high) / 2.0 };
        match fit(shapes, ceiling * share, size) {
            Some(packing) => {
                low = share;
                best = Some(packing);
            }
            None => high = share,
        }
    }
    best
}

/// Packs the shapes at a scale; `None` when they do not fit.
fn fit(shapes: &[ChartOutline], scale: f64, size: u32) -> Option<SheetPacking> {
    look();
    let room = f64::from(size - GAP.min(size - 1));
    if shapes.iter().any(|shape| shape.side.max_element() * scale > room) {
        return None;
    }
    let boxed = |shape: &ChartOutline| {
        let [width, height] = shape.texels(scale).map(|texels| f64::from(texels + GAP));
        width * height
    };
    let (cell, limit) = cells(shapes.len(), size);
    if shapes.iter().map(boxed).sum::<f64>() > MOST_BOXED * f64::from(cell).powi(2) {
        return None;
    }
    // The texels of a shape are dropped before those of the next one are made.
    let drawn = shapes.par_iter().map(|shape| {
        let mask = shape.mask(scale);
        ([mask.width, mask.height].map(u64::from), turns(mask, cell))
    });
    let (sides, turned): (Vec<[u64; 2]>, Vec<[Mask; 4]>) = drawn.unzip();
    let key = |[width, height]: [u64; 2]| (std::cmp::Reverse((width.max(height), width * height)), width, height);
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by_key(|&index| (key(sides[index]), index));
    let taken: u64 = turned.iter().map(|[mask, ..]| mask.count()).sum();
    let widest = turned.iter().map(|[mask, ..]| mask.width.max(mask.height)).max();
    if taken > u64::from(limit).pow(2) || widest.is_some_and(|widest| widest > limit) {
        return None;
    }
    let mut packer = Packer::with_columns(limit, limit);
    let mut places = vec![(0, DVec2::ZERO); shapes.len()];
    for index in order {
        look();
        let found = turned[index].each_ref().map(|mask| packer.find(mask));
        // The rotation that ends topmost leaves the most space.
        let reach = |turns: usize| (found[turns].page, found[turns].row + turned[index][turns].height, turns);
        // The minimum of four turns exists.
        let turns = (0..4).min_by_key(|&turns| reach(turns)).unwrap_or(0);
        let position = found[turns];
        if position.page > 0 {
            return None;
        }
        packer.take(&turned[index][turns], position);
        // The mask starts half a gap before its shape.
        let place = |cells: u32| f64::from(cells * cell + GAP / 2);
        places[index] = (turns as u32, DVec2::new(place(position.column), place(position.row)));
    }
    Some(SheetPacking { scale, size, places })
}

/// Texels along a side of a packed cell, and cells along a side of the sheet.
fn cells(charts: usize, size: u32) -> (u32, u32) {
    let cells = if charts > MANY { CELLS[1] } else { CELLS[0] };
    let cell = (size / cells).max(1).next_power_of_two();
    (cell, size / cell)
}

/// Returns a mask in cells, as it is and after one, two and three quarter turns.
fn turns(mask: Mask, cell: u32) -> [Mask; 4] {
    let once = mask.turned();
    let twice = once.turned();
    let thrice = twice.turned();
    [mask, once, twice, thrice].map(|mask| mask.cells(cell))
}

/// Returns the mean by area, and the maximum over 99.9 % of the area, of the ratio between the singular values of the map
/// from a triangle in space to the sheet.
fn stretch(mesh: &Mesh, charts: &[FlatChart]) -> (f32, f32) {
    let members = charts
        .par_iter()
        .flat_map_iter(|chart| chart.triangles.iter().zip(&chart.corners));
    let mut found: Vec<(f64, f64)> = members
        .filter_map(|(&triangle, &flat)| Some((ratio(mesh, triangle, flat)?, area(mesh, triangle))))
        .collect();
    found.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let total: f64 = found.iter().map(|(_, area)| area).sum();
    let mean = found.iter().map(|(ratio, area)| ratio * area).sum::<f64>() / total.max(f64::MIN_POSITIVE);
    let mut below = 0.0;
    let worst = found.iter().find(|(_, area)| {
        below += area;
        below >= 0.999 * total
    });
    (mean as f32, worst.map_or(1.0, |(ratio, _)| *ratio) as f32)
}

fn ratio(mesh: &Mesh, triangle: u32, [a_flat, b_flat, c_flat]: [DVec2; 3]) -> Option<f64> {
    let [a, b, c] = mesh.corners(triangle);
    let (ab, ac) = (b - a, c - a);
    let (along, across) = (ab.length(), ab.cross(ac).length() / ab.length());
    // Columns of the map: the images of a unit vector along the first edge and of one perpendicular to it.
    let x = (b_flat - a_flat) / along;
    let shift = ac.dot(ab) / along;
    let y = (c_flat - a_flat - x * shift) / across;
    let (sum, determinant) = (x.length_squared() + y.x * y.x + y.y * y.y, x.perp_dot(y));
    let root = ((sum / 2.0).powi(2) - determinant.powi(2)).max(0.0).sqrt();
    let ratio = ((sum / 2.0 + root) / determinant.abs()).abs();
    (ratio.is_finite() && determinant != 0.0).then_some(ratio)
}

fn warnings(mesh: &Mesh, charts: &[FlatChart], report: &UnwrapReport, size: u32) -> Vec<String> {
    let mut warnings = Vec::new();
    if report.gap < GAP as f32 {
        warnings.push(format!(
            "{} charts are too many for gaps of {GAP} texels at size {size}; theirs are {} wide there, so a larger size would help",
            report.charts, report.gap
        ));
    }
    let placed: usize = charts.iter().map(|chart| chart.triangles.len()).sum();
    let with_area = (0..mesh.triangles.len() as u32)
        .filter(|&triangle| area(mesh, triangle) > 0.0)
        .count();
    let lost = with_area.saturating_sub(placed);
    if lost > 0 {
        let triangles = if lost == 1 { "triangle is" } else { "triangles are" };
        warnings.push(format!("{lost} {triangles} too thin to have a place on the sheet"));
    }
    warnings
}
