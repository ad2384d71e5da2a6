//! Test
//! A node with a fault.
//! @use nosie

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.x;
}
