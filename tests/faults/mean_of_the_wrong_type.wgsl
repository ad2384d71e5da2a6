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
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return straight(at, f32(index));
}

/// A mean.
/// @pass 1
fn far(hit: Hit) -> f32 {
    return hit.distance;
}

/// The mask.
fn mask(far: vec3f) -> f32 {
    return far.x;
}
