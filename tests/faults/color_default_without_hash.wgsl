//! Test
//! A node with a fault.

struct Params {
    /// Its color.
    /// @color @default gray
    color: vec3f,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.color.x;
}
