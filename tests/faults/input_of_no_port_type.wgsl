//! Test
//! A node with a fault.

/// The mask.
/// @input source What it starts from.
fn mask(source: vec2f) -> f32 {
    return source.x;
}
