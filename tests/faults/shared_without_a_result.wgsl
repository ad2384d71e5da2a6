//! Test
//! A node with a fault.

/// What is near.
/// @shared
fn found(at: Surface) {
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.y;
}
