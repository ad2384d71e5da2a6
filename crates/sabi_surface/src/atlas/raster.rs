//! Rasterization of triangles with integers only: every texel center on a shared edge belongs to exactly one of the two triangles.

use std::ops::Range;

use super::fixed_point_uvs::UNIT;

const HALF: i64 = UNIT / 2;

/// Calls `paint(y, x0, x1)` for each row of texels, `x1` excluded, whose centers lie inside a triangle.
///
/// Corners are in parts of a texel ([`UNIT`]), within ±2³⁸. A center on an edge belongs to the triangle whose top or
/// left edge it is. Only `rows` are visited. Triangles of either winding are painted; those without area paint
/// nothing.
pub(crate) fn spans(corners: [[i64; 2]; 3], rows: Range<i64>, mut paint: impl FnMut(i64, i64, i64)) {
    let origin = [corners[0][0] & -UNIT, corners[0][1] & -UNIT];
    // In coordinates relative to the triangle's origin, products stay far below 2⁶³ for any triangle that fits on a page.
    let mut c = corners.map(|corner| [corner[0] - origin[0], corner[1] - origin[1]]);
    let area2 = (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[1][1] - c[0][1]) * (c[2][0] - c[0][0]);
    if area2 == 0 {
        return;
    }
    if area2 < 0 {
        c.swap(1, 2);
    }
    let (x_origin, y_origin) = (origin[0] / UNIT, origin[1] / UNIT);
    let low = c[0][1].min(c[1][1]).min(c[2][1]);
    let high = c[0][1].max(c[1][1]).max(c[2][1]);
    let first = ceil_center(low).max(rows.start - y_origin);
    let last = floor_center(high).min(rows.end - 1 - y_origin);
    let edges = [
        EdgeFunction::new(c[0], c[1]),
        EdgeFunction::new(c[1], c[2]),
        EdgeFunction::new(c[2], c[0]),
    ];
    for y in first..=last {
        let center = y * UNIT + HALF;
        let (mut x0, mut x1) = (i64::MIN, i64::MAX);
        for edge in &edges {
            edge.clip(center, &mut x0, &mut x1);
        }
        if x0 <= x1 {
            paint(y + y_origin, x0 + x_origin, x1 + 1 + x_origin);
        }
    }
}

/// First texel whose center is at or after a coordinate.
fn ceil_center(value: i64) -> i64 {
    (value - HALF + UNIT - 1).div_euclid(UNIT)
}

/// Last texel whose center is at or before a coordinate.
fn floor_center(value: i64) -> i64 {
    (value - HALF).div_euclid(UNIT)
}

/// An edge with the inside on the side where `dx · (Y − y) − dy · (X − x)` is positive.
struct EdgeFunction {
    from: [i64; 2],
    dx: i64,
    dy: i64,
    /// 0 when the edge itself is inside (a top or left edge), else 1.
    bias: i64,
}

impl EdgeFunction {
    fn new(from: [i64; 2], to: [i64; 2]) -> EdgeFunction {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let inside = dy < 0 || (dy == 0 && dx > 0);
        EdgeFunction {
            from,
            dx,
            dy,
            bias: i64::from(!inside),
        }
    }

    /// Narrows a row's texels `x0..=x1` to those inside.
    fn clip(&self, center_y: i64, x0: &mut i64, x1: &mut i64) {
        let k = self.dx * (center_y - self.from[1]) + self.dy * self.from[0] - self.bias;
        match self.dy {
            0 if k < 0 => *x1 = i64::MIN,
            0 => {}
            dy if dy > 0 => *x1 = (*x1).min(floor_center(k.div_euclid(dy))),
            dy => *x0 = (*x0).max(ceil_center(-((k).div_euclid(-dy)))),
        }
    }
}
