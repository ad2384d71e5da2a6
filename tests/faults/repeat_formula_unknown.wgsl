//! Test
//! A node with a fault.
//! @use surface

struct Params {
    /// How far.
    /// @length @default 0.1
    radius: f32,
}

/// The mask.
/// @input source What it starts from.
/// @repeat ceil(params.radius / tezel)
fn mask(at: Surface, source: texture_2d_array<f32>, params: Params) -> f32 {
    return here(source, at).x * params.radius;
}
