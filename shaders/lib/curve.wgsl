//! Curves: cubic pieces from point to point.

/// The curve at `x`: held before the first point and behind the last one, and never beyond the two points it runs between.
///
/// A point is x, y and slope; unused ones repeat the last. Two points at one x are a step.
fn curve_at(points: array<vec4f, 16>, x: f32) -> f32 {
    var result = points[0].y;
    result = past_point(result, points[0], points[1], x);
    result = past_point(result, points[1], points[2], x);
    result = past_point(result, points[2], points[3], x);
    result = past_point(result, points[3], points[4], x);
    result = past_point(result, points[4], points[5], x);
    result = past_point(result, points[5], points[6], x);
    result = past_point(result, points[6], points[7], x);
    result = past_point(result, points[7], points[8], x);
    result = past_point(result, points[8], points[9], x);
    result = past_point(result, points[9], points[10], x);
    result = past_point(result, points[10], points[11], x);
    result = past_point(result, points[11], points[12], x);
    result = past_point(result, points[12], points[13], x);
    result = past_point(result, points[13], points[14], x);
    result = past_point(result, points[14], points[15], x);
    return result;
}

// Goes on to the piece between two points where `x` is past the first.
fn past_point(result: f32, left: vec4f, right: vec4f, x: f32) -> f32 {
    return select(result, curve_piece(left, right, x), x >= left.x);
}

// A cubic Hermite piece, in the form that gives a straight line exactly.
fn curve_piece(left: vec4f, right: vec4f, x: f32) -> f32 {
    let width = right.x - left.x;
    let whole = max(width, 1e-6);
    let step = min(x - left.x, width);
    let t = step / whole;
    let secant = (right.y - left.y) / whole;
    let bend = 3.0 * secant - 2.0 * left.z - right.z;
    let twist = left.z + right.z - 2.0 * secant;
    let y = left.y + step * (left.z + t * (bend + t * twist));
    return select(clamp(y, min(left.y, right.y), max(left.y, right.y)), right.y, width < 1e-6);
}
