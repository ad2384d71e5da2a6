//! Test
//! A node with a fault.

/// The mask.
/// @input sorce What it starts from.
fn mask(source: f32) -> f32 {
    return source;
}
