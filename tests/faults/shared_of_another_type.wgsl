//! Test
//! A node with a fault.

struct Found {
    near: f32,
}

/// What is near.
/// @shared
fn found(at: Surface) -> Found {
    return Found(at.position.x);
}

/// The mask.
fn mask(found: f32) -> f32 {
    return found;
}
