//! Direction
//! Selects the parts of the surface that face one way, such as up for dust and moss.
//!
//! @alias direction normal facing up slope dust snow

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
    let size = length(params.toward);
    let toward = params.toward / max(size, 1e-12);
    // The angle by half the chord: exact for small angles, where the arc cosine of a rounded product is not.
    let angle = 2.0 * asin(min(0.5 * length(at.normal - toward), 1.0));
    let t = clamp((params.reach - angle) / max(params.reach * params.fade, 1e-4), 0.0, 1.0);
    return select(0.0, t * t * (3.0 - 2.0 * t), size > 1e-6);
}
