//! Test
//! A node with a fault.

/// The mask.
/// @input source What it starts from.
/// @input mask_in Where it shows.
fn mask(source: f32, mask_in: f32) -> f32 {
    let weighted = mask_in * 2.0;
    return source;
}
