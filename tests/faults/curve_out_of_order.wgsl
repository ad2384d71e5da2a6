//! Test
//! A node with a fault.

struct Params {
    /// The curve.
    /// @curve @default 1 0 0 1
    points: array<vec4f, 4>,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.points[0].y;
}
