//! Test
//! A node with a fault.
//! @use surface

/// The mask.
/// @input source What it starts from.
/// @texel 0.01
fn mask(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return here(source, at).x;
}
