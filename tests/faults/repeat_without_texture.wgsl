//! Test
//! A node with a fault.

/// The mask.
/// @repeat 4
fn mask(at: Surface) -> f32 {
    return at.position.x;
}
