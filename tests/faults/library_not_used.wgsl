//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    return waves(at.position, 4u);
}
