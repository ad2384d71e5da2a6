//! Test
//! A node with a fault.

/// The mask.
/// @input way The way. @vector @default at.postion
fn mask(way: vec3f) -> f32 {
    return dot(way, way);
}
