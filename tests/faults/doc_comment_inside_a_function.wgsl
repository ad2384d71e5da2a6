//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    /// Only the height counts.
    return at.position.y;
}
