//! Relief direction
//! Selects the parts of the relief that face one way: the upper sides of bumps, where dust lies and water runs.
//!
//! As Direction, but of the relief that the graph has made, which stands out of the model's surface.
//! @alias direction normal facing up bump dust snow
//! @use facing surface

struct Params {
    /// The way to face, in model space; no way at all selects nothing.
    /// @range -1 1 @default 0 1 0
    toward: vec3f,
    /// How far from that way the mask still reaches.
    /// @angle @range 0 180 @default 60
    reach: f32,
    /// The outer share of the reach over which the mask fades.
    /// @range 0 1 @default 0.5
    fade: f32,
}

/// How much the relief faces that way.
/// @input height The relief, in model units.
fn mask(at: Surface, params: Params, height: texture_2d_array<f32>) -> f32 {
    let normal = unit_or(at.normal - surface_gradient(height, at), at.normal);
    return facing(normal, params.toward, params.reach, params.fade);
}
