//! Test
//! A node with a fault.

struct Params {
    /// The curve.
    /// @curve @range 0 1 @default 0 0 1 2
    points: array<vec4f, 4>,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.points[0].y;
}
