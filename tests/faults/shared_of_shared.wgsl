//! Test
//! A node with a fault.

/// What is near.
/// @shared
fn found(at: Surface) -> f32 {
    return at.position.x;
}

/// What is far.
/// @shared
fn far(found: f32) -> f32 {
    return 1.0 - found;
}

/// The mask.
fn mask(found: f32, far: f32) -> f32 {
    return found * far;
}
