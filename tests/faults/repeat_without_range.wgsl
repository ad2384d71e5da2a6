//! Test
//! A node with a fault.
//! @use surface

struct Params {
    /// How often.
    /// @default 4
    steps: u32,
}

/// The mask.
/// @input source What it starts from.
/// @repeat params.steps
fn mask(at: Surface, source: texture_2d_array<f32>, params: Params) -> f32 {
    return here(source, at).x * f32(params.steps);
}
