//! Test
//! A node with a fault.

/// The mask.
fn mask(source: f32) -> f32 {
    return source;
}
