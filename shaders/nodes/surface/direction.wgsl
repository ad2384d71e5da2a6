//! Direction
//! Selects the parts of the surface that face in a direction, such as up for dust and moss.
//!
//! @alias direction normal facing up slope dust snow
//! @use facing

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

/// 1 where the surface faces exactly in the direction, 0 beyond Reach.
fn mask(at: Surface, params: Params) -> f32 {
    return facing(at.normal, params.toward, params.reach, params.fade);
}
