//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    if at.position.x > 1.0 {
        return mask(at);
    }
    return at.position.x;
}
