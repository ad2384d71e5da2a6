//! Test
//! A node with a fault.
//! @use rays

struct Params {
    /// How many.
    /// @range 1 64 @default 8
    rays: u32,
}

/// The rays.
/// @rays params.rays
fn ray(at: Surface, index: f32, params: Params) -> Ray {
    return straight(at, index);
}

/// The mask.
fn mask(hit: Hit) -> f32 {
    return hit.distance;
}

