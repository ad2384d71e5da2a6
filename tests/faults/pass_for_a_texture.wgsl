//! Test
//! A node with a fault.
//! @use surface

/// The mask here.
/// @pass 1 @with source
/// @input source What is read.
fn stored(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return here(source, at).x;
}

/// The mask.
fn mask(at: Surface, stored: texture_2d_array<f32>) -> f32 {
    return here(stored, at).x;
}
