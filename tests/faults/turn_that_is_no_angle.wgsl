//! Test
//! A node with a fault.
//! @use rays

struct Params {
    /// How many.
    /// @range 1 8 @default 8
    rays: u32,
    /// How far.
    /// @range 0 1 @default 1
    far: f32,
}

/// The rays.
/// @rays params.rays @turn params.far
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return straight(at, f32(index) * params.far);
}

/// The mask.
fn mask(hit: Hit) -> f32 {
    return hit.distance;
}

