//! Relief direction
//! Selects the parts of the relief that face in a direction: the upper sides of bumps, where dust lies.
//!
//! Like Direction, but for the relief that the graph creates on the model's surface.
//! @alias direction normal facing up bump dust snow
//! @use facing surface

struct Params {
    /// The direction, in model space; 0, 0, 0 selects nothing.
    /// @range -1 1 @default 0 1 0
    toward: vec3f,
    /// Largest angle to the direction that is still selected.
    /// @angle @range 0 180 @default 60
    reach: f32,
    /// Outer share of Reach over which the mask fades.
    /// @range 0 1 @default 0.5
    fade: f32,
}

/// 1 where the relief faces in the direction, 0 where it does not.
/// @input height The height that the graph creates, in working units.
fn mask(at: Surface, params: Params, height: texture_2d_array<f32>) -> f32 {
    let normal = unit_or(at.normal - surface_gradient(height, at), at.normal);
    return facing(normal, params.toward, params.reach, params.fade);
}
