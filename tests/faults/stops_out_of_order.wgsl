//! Test
//! A node with a fault.

struct Params {
    /// The ramp.
    /// @default 1 #000000 0 #ffffff
    ramp: array<vec4f, 4>,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.ramp[0].x;
}
