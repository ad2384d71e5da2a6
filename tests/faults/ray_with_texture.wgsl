//! Test
//! A node with a fault.
//! @use rays surface

struct Params {
    /// How many.
    /// @range 1 64 @default 8
    rays: u32,
}

/// The rays.
/// @rays params.rays
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return straight(at, f32(index));
}

/// The mask.
/// @input source What is read.
fn mask(hit: Hit, source: texture_2d_array<f32>, at: Surface) -> f32 {
    return hit.distance * here(source, at).x;
}
