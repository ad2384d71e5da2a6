//! Test
//! A node with a fault.

/// The mask.
fn mask(
    /// The place.
    at: Surface,
) -> f32 {
    return at.position.y;
}
