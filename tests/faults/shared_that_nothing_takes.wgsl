//! Test
//! A node with a fault.

/// What is near.
/// @shared
fn found(at: Surface) -> f32 {
    return at.position.x;
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.y;
}
