//! Test
//! A node with a fault.

diagnostic(off, derivative_uniformity);

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.x;
}
