//! Test
//! A node with a fault.
//! @use surface

/// What is near.
/// @shared
fn found(at: Surface) -> f32 {
    return at.position.x;
}

/// The mask.
/// @input source What is read.
fn mask(at: Surface, found: f32, source: texture_2d_array<f32>) -> f32 {
    return found * here(source, at).x;
}
