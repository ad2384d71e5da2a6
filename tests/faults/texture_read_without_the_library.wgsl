//! Test
//! A node with a fault.

/// The mask.
/// @input source What it starts from.
fn mask(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return textureLoad(source, at.texel.xy, at.texel.z, 0).x;
}
