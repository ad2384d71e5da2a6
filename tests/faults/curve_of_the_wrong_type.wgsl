//! Test
//! A node with a fault.

struct Params {
    /// The curve.
    /// @curve @default 0 0 1 1
    points: vec4f,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.points.x;
}
