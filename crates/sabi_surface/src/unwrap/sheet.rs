//! All charts at one scale on one sheet, as large as they fit.

use rayon::prelude::*;

use super::flatten::FlatChart;
use super::{GAP, Sheet, UnwrapError, UnwrapReport};
use crate::atlas::fixed::UNIT;
use crate::atlas::mask::Mask;
use crate::atlas::pack::Packer;
use crate::atlas::raster::spans;
use crate::model::Mesh;

/// Cells along a side that charts are packed in, and that more than [`MANY`] of them are.
const CELLS: [u32; 2] = [512, 4096];
/// More charts than this are too small for the coarser cells.
const MANY: usize = 10_000;
/// Bisection steps of the scale: to 1/2⁷ of the range between a scale that fits and one that does not.
const STEPS: u32 = 7;
/// Share of the sheet that charts never cover together.
const TOO_FULL: f64 = 0.95;
/// Texels of the boxes around all charts, as far as memory is taken for them: 256 MB.
const MOST_BOXED: f64 = (1u64 << 31) as f64;

/// Area of a triangle in space, 0 where it has none beyond what rounding its positions could make.
pub(super) fn area(mesh: &Mesh, triangle: u32) -> f64 {
    let [a, b, c] = mesh.triangles[triangle as usize]
        .map(|vertex| glam::DVec3::from(mesh.positions[vertex as usize].map(f64::from)));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let twice = (b - a).cross(c - a).length();
    if twice > longest * longest * 1e-9 {
        twice / 2.0
    } else {
        0.0
    }
}

/// Two corners.
type Edge = [[f64; 2]; 2];

/// A chart with its corner at the origin.
struct Shape<'a> {
    chart: &'a FlatChart,
    origin: [f64; 2],
    /// Width and height, model units.
    side: [f64; 2],
    /// Edges with one triangle.
    outline: Vec<Edge>,
}

impl Shape<'_> {
    fn new(chart: &FlatChart) -> Shape<'_> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in chart.corners.iter().flatten() {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let edges = chart.corners.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut keyed: Vec<([[u64; 2]; 2], Edge)> = edges
            .map(|[a, b]| {
                let mut key = [a, b].map(|corner| corner.map(f64::to_bits));
                key.sort_unstable();
                (key, [a, b])
            })
            .collect();
        keyed.sort_unstable_by_key(|(key, _)| *key);
        let outline = keyed.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() == 1);
        Shape {
            chart,
            origin: low,
            side: [high[0] - low[0], high[1] - low[1]],
            outline: outline.map(|group| group[0].1).collect(),
        }
    }

    /// A corner in texels from the shape's own corner.
    fn texel(&self, corner: [f64; 2], scale: f64) -> [f64; 2] {
        [0, 1].map(|axis| (corner[axis] - self.origin[axis]) * scale)
    }

    /// Returns the width and height of the shape at a scale, in whole texels.
    fn texels(&self, scale: f64) -> [u32; 2] {
        self.side.map(|side| (side * scale).floor() as u32 + 1)
    }

    /// A corner as [`Shape::texel`], after so many quarter turns of [`Mask::turned`].
    fn turned_texel(&self, corner: [f64; 2], scale: f64, turns: u32) -> [f64; 2] {
        let [x, y] = self.texel(corner, scale);
        let [width, height] = self.texels(scale).map(f64::from);
        match turns {
            0 => [x, y],
            1 => [y, width - x],
            2 => [width - x, height - y],
            _ => [height - y, x],
        }
    }

    /// Texels that the shape touches at a scale, with room around it.
    fn mask(&self, scale: f64) -> Mask {
        let [width, height] = self.texels(scale);
        let mut mask = Mask::empty([0, 0], width, height);
        for triangle in &self.chart.corners {
            let corners = triangle.map(|corner| self.texel(corner, scale));
            let fixed = corners.map(|corner| corner.map(|value| (value * UNIT as f64).round() as i64));
            spans(fixed, (0, i64::from(height)), |y, x0, x1| {
                mask.set(y, x0.max(0), x1.min(i64::from(width)));
            });
        }
        // Centers alone would miss what is thin: every texel along the outline counts, too.
        for edge in &self.outline {
            let [from, to] = edge.map(|corner| self.texel(corner, scale));
            let steps = (2.0 * (to[0] - from[0]).abs().max((to[1] - from[1]).abs())).ceil() as u32 + 1;
            for step in 0..=steps {
                let t = f64::from(step) / f64::from(steps);
                let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * t);
                let x = (at[0] as u32).min(width - 1);
                let y = (at[1] as u32).min(height - 1);
                mask.set(i64::from(y), i64::from(x), i64::from(x) + 1);
            }
        }
        mask.grown()
    }
}

/// Placement of all charts on the sheet.
struct Packing {
    /// Texels a unit of length.
    scale: f64,
    /// Texels along a side of the sheet that it was packed for.
    size: u32,
    /// Quarter turns of each chart, and the texel of its corner after them.
    places: Vec<(u32, [f64; 2])>,
}

/// Packs charts as large as they fit with [`GAP`] texels between them on a sheet of `size` texels. Where there are too many
/// of them for that, it has more texels, up to `finest`, so that the gaps get narrower.
pub(super) fn pack(mesh: &Mesh, charts: &[FlatChart], [size, finest]: [u32; 2]) -> Result<Sheet, UnwrapError> {
    let shapes: Vec<Shape> = charts.par_iter().map(Shape::new).collect();
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
                [0, 1].map(|axis| ((texel[axis] + at[axis]) / side) as f32)
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
    Ok(Sheet { corners, report })
}

/// The largest scale at which all shapes fit, as far as it is looked for.
fn largest(shapes: &[Shape], total: f64, size: u32) -> Option<Packing> {
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
        // Most layouts fill the sheet by half to three quarters.
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

/// The shapes at a scale on one sheet; none when they do not fit.
fn fit(shapes: &[Shape], scale: f64, size: u32) -> Option<Packing> {
    let room = f64::from(size - GAP.min(size - 1));
    if shapes
        .iter()
        .any(|shape| shape.side[0].max(shape.side[1]) * scale > room)
    {
        return None;
    }
    let boxed = |shape: &Shape| {
        let [width, height] = shape.texels(scale).map(|texels| f64::from(texels + GAP));
        width * height
    };
    if shapes.iter().map(boxed).sum::<f64>() > MOST_BOXED {
        return None;
    }
    let (cell, limit) = cells(shapes.len(), size);
    let masks: Vec<Mask> = shapes.par_iter().map(|shape| shape.mask(scale)).collect();
    let key = |mask: &Mask| {
        let (width, height) = (u64::from(mask.width), u64::from(mask.height));
        (std::cmp::Reverse((width.max(height), width * height)), width, height)
    };
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by_key(|&index| (key(&masks[index]), index));
    let turned: Vec<[Mask; 4]> = masks.into_par_iter().map(|mask| turns(mask, cell)).collect();
    let taken: u64 = turned.iter().map(|[mask, ..]| mask.count()).sum();
    let widest = turned.iter().map(|[mask, ..]| mask.width.max(mask.height)).max();
    if taken > u64::from(limit).pow(2) || widest.is_some_and(|widest| widest > limit) {
        return None;
    }
    let mut packer = Packer::with_columns(limit, limit);
    let mut places = vec![(0, [0.0; 2]); shapes.len()];
    for index in order {
        let found = turned[index].each_ref().map(|mask| packer.find(mask));
        // The turn that leaves most room below.
        let reach = |turns: usize| (found[turns].page, found[turns].row + turned[index][turns].height, turns);
        // The minimum of four turns exists.
        let turns = (0..4).min_by_key(|&turns| reach(turns)).unwrap_or(0);
        let spot = found[turns];
        if spot.page > 0 {
            return None;
        }
        packer.take(&turned[index][turns], spot);
        // The mask begins half a gap before its shape.
        let place = |cells: u32| f64::from(cells * cell + GAP / 2);
        places[index] = (turns as u32, [place(spot.column), place(spot.row)]);
    }
    Some(Packing { scale, size, places })
}

/// Texels along a side of a packed cell, and cells along a side of the sheet.
fn cells(charts: usize, size: u32) -> (u32, u32) {
    let cells = if charts > MANY { CELLS[1] } else { CELLS[0] };
    let cell = (size / cells).max(1).next_power_of_two();
    (cell, size / cell)
}

/// A mask in cells, and after one, two and three quarter turns.
fn turns(mask: Mask, cell: u32) -> [Mask; 4] {
    let once = mask.turned();
    let twice = once.turned();
    let thrice = twice.turned();
    [mask, once, twice, thrice].map(|mask| mask.cells(cell))
}

/// Area of a triangle in the plane.
pub(super) fn flat_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0
}

/// Mean by area, and the worst of 99.9 % of the area, of the ratio between the singular values of the map from a triangle
/// in space to the sheet.
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

fn ratio(mesh: &Mesh, triangle: u32, flat: [[f64; 2]; 3]) -> Option<f64> {
    let [a, b, c] = mesh.triangles[triangle as usize]
        .map(|vertex| glam::DVec3::from(mesh.positions[vertex as usize].map(f64::from)));
    let (ab, ac) = (b - a, c - a);
    let (along, across) = (ab.length(), ab.cross(ac).length() / ab.length());
    let edge = |to: usize| [flat[to][0] - flat[0][0], flat[to][1] - flat[0][1]];
    let (p, q) = (edge(1), edge(2));
    // Columns: where one unit along the first edge goes, and one at a right angle to it.
    let x = p.map(|value| value / along);
    let shift = ac.dot(ab) / along;
    let y = [0, 1].map(|axis| (q[axis] - x[axis] * shift) / across);
    let (sum, determinant) = (
        x[0] * x[0] + x[1] * x[1] + y[0] * y[0] + y[1] * y[1],
        x[0] * y[1] - x[1] * y[0],
    );
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
