//! Charts onto one square sheet: one density for all of them, whole-texel corners, a gap that no filter crosses.

use glam::{DVec2, dvec2};

use super::charted_mesh::ModelPart;

/// The sheet that gaps are promised for, in texels.
pub(crate) const SHEET_PX: i32 = 1024;
/// Free texels between charts, and between charts and the border, at that size.
pub(crate) const GAP_PX: i32 = 8;

/// Position of a chart on the packed sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackedPlace {
    /// The chart's lowest sheet coordinates, in meters.
    low: DVec2,
    /// Its height before turning, in meters.
    height: f64,
    /// Its lower left texel.
    corner_px: [i32; 2],
    /// True if it is rotated by a quarter turn.
    turned: bool,
    /// Texels a meter.
    density: f64,
}

impl PackedPlace {
    /// The glTF texture coordinate (v downward) of a sheet coordinate.
    pub(crate) fn uv_from_sheet(&self, sheet: DVec2) -> [f32; 2] {
        let own = sheet - self.low;
        let own = if self.turned {
            dvec2(self.height - own.y, own.x)
        } else {
            own
        };
        let px = dvec2(f64::from(self.corner_px[0]), f64::from(self.corner_px[1])) + own * self.density;
        let uv = px / f64::from(SHEET_PX);
        [uv.x as f32, (1.0 - uv.y) as f32]
    }
}

/// Places every chart of every part, at the highest density at which all of them fit.
pub(crate) fn pack(parts: &[ModelPart]) -> Vec<Vec<PackedPlace>> {
    let bounds: Vec<(DVec2, DVec2)> = parts.iter().flat_map(chart_bounds).collect();
    let sizes: Vec<DVec2> = bounds.iter().map(|(low, high)| *high - *low).collect();
    let area: f64 = sizes.iter().map(|size| size.x * size.y).sum();
    let mut density = f64::from(SHEET_PX) / area.sqrt();
    let corners = loop {
        if let Some(corners) = place_all(&sizes, density) {
            break corners;
        }
        density *= 0.998;
    };
    let mut places = bounds
        .iter()
        .zip(corners)
        .map(|(&(low, high), (corner_px, turned))| PackedPlace {
            low,
            height: high.y - low.y,
            corner_px,
            turned,
            density,
        });
    parts
        .iter()
        .map(|part| places.by_ref().take(part.shape.charts).collect())
        .collect()
}

fn chart_bounds(part: &ModelPart) -> Vec<(DVec2, DVec2)> {
    let mut bounds = vec![(DVec2::INFINITY, DVec2::NEG_INFINITY); part.shape.charts];
    for triangle in &part.shape.triangles {
        for corner in triangle.corners {
            let (low, high) = &mut bounds[triangle.chart];
            *low = low.min(corner.sheet);
            *high = high.max(corner.sheet);
        }
    }
    bounds
}

/// A rectangle of texels: left, bottom, width, height.
type Rect = [i32; 4];

/// Corners and turns for charts of the given sizes in meters, or none when they do not fit at this density.
fn place_all(sizes: &[DVec2], density: f64) -> Option<Vec<([i32; 2], bool)>> {
    // The gap above and to the right of each chart is part of its rectangle; the one at the border is the margin.
    let texels = |meters: f64| (meters * density - 1e-6).ceil() as i32 + GAP_PX;
    let area = |size: &DVec2| texels(size.x) * texels(size.y);
    if sizes.iter().map(area).sum::<i32>() > (SHEET_PX - GAP_PX) * (SHEET_PX - GAP_PX) {
        return None;
    }
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    let longest = |i: usize| texels(sizes[i].max_element());
    order.sort_by_key(|&i| (-longest(i), -texels(sizes[i].min_element()), i));
    let mut free: Vec<Rect> = vec![[GAP_PX, GAP_PX, SHEET_PX - GAP_PX, SHEET_PX - GAP_PX]];
    let mut found = vec![([0, 0], false); sizes.len()];
    for i in order {
        let (width, height) = (texels(sizes[i].x), texels(sizes[i].y));
        let (rect, turned) = best_place(&free, width, height)?;
        found[i] = ([rect[0], rect[1]], turned);
        free = without(&free, rect);
    }
    Some(found)
}

/// The free rectangle that leaves the least beside the chart, upright or turned.
fn best_place(free: &[Rect], width: i32, height: i32) -> Option<(Rect, bool)> {
    let mut best: Option<([i32; 4], Rect, bool)> = None;
    for &[x, y, free_width, free_height] in free {
        for (w, h, turned) in [(width, height, false), (height, width, true)] {
            if w <= free_width && h <= free_height {
                let (beside, above) = (free_width - w, free_height - h);
                let score = [beside.min(above), beside.max(above), y, x];
                if best.is_none_or(|(least, ..)| score < least) {
                    best = Some((score, [x, y, w, h], turned));
                }
            }
        }
    }
    best.map(|(_, rect, turned)| (rect, turned))
}

/// The largest free rectangles once one is taken (Jylänki, "A thousand ways to pack the bin", MaxRects).
fn without(free: &[Rect], [x, y, width, height]: Rect) -> Vec<Rect> {
    let mut pieces = Vec::new();
    for &[fx, fy, fw, fh] in free {
        if x >= fx + fw || x + width <= fx || y >= fy + fh || y + height <= fy {
            pieces.push([fx, fy, fw, fh]);
            continue;
        }
        pieces.push([fx, fy, x - fx, fh]);
        pieces.push([x + width, fy, fx + fw - x - width, fh]);
        pieces.push([fx, fy, fw, y - fy]);
        pieces.push([fx, y + height, fw, fy + fh - y - height]);
    }
    pieces.retain(|&[_, _, w, h]| w > 0 && h > 0);
    pieces.sort_unstable();
    pieces.dedup();
    let inside =
        |a: &Rect, b: &Rect| a[0] >= b[0] && a[1] >= b[1] && a[0] + a[2] <= b[0] + b[2] && a[1] + a[3] <= b[1] + b[3];
    let all = pieces.clone();
    pieces.retain(|piece| !all.iter().any(|other| other != piece && inside(piece, other)));
    pieces
}
