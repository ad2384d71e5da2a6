//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    if at.position.x > 0.0 {
        discard;
    }
    return 1.0;
}
