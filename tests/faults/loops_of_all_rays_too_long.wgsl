//! Test
//! A node with a fault.
//! @use rays

struct Params {
    /// How many.
    /// @range 1 256 @default 8
    rays: u32,
}

/// The rays.
/// @rays params.rays
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return straight(at, f32(index));
}

/// The mask.
fn mask(hit: Hit) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < 257u; i++) {
        sum += hit.distance;
    }
    return sum;
}
