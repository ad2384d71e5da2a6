//! Test
//! A node with a fault.

/// The mask.
/// @input source What it starts from.
/// @input maks Where it shows.
fn mask(source: f32) -> f32 {
    return source;
}
