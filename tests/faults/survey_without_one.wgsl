//! Test
//! A node with a fault.

/// The mask.
/// @surveys source
/// @input source What is surveyed.
fn mask(source: f32) -> f32 {
    return source;
}
