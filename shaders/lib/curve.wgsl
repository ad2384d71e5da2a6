//! Curves: cubic pieces from point to point.

/// The curve at `x`: held before the first point and behind the last one, and never beyond the two points it runs between.
///
/// A point is x, y and slope; unused ones repeat the last. Two points at one x are a step.
fn curve_at(points: array<vec4f, 16>, x: f32) -> f32 {
    var result = points[0].y;
    for (var i = 0u; i < 15u; i += 1u) {
        if x >= points[i].x {
            result = curve_piece(points[i], points[i + 1u], x);
        }
    }
    return result;
}

// A cubic Hermite piece, in the form that gives a straight line exactly.
fn curve_piece(left: vec4f, right: vec4f, x: f32) -> f32 {
    let width = right.x - left.x;
    if width < 1e-6 {
        return right.y;
    }
    let step = min(x - left.x, width);
    let t = step / width;
    let secant = (right.y - left.y) / width;
    let bend = 3.0 * secant - 2.0 * left.z - right.z;
    let twist = left.z + right.z - 2.0 * secant;
    let y = left.y + step * (left.z + t * (bend + t * twist));
    return clamp(y, min(left.y, right.y), max(left.y, right.y));
}
