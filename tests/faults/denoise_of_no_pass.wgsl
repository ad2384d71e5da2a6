//! Test
//! A node with a fault.

/// The mask.
/// @denoise shading
fn mask(at: Surface) -> f32 {
    return at.position.x;
}
