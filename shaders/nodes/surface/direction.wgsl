//! Direction
//! Selects the parts of the surface that face one way, such as up for dust and moss.
//!
//! @alias direction normal facing up slope dust snow
//! @use facing

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

/// How much this place faces that way: exactly 1 when it does.
fn mask(at: Surface, params: Params) -> f32 {
    return facing(at.normal, params.toward, params.reach, params.fade);
}
