//! Threshold
//! Cuts a mask into inside and outside, with a hard or a soft border.
//!
//! The values of a noise are spread evenly from 0 to 1, so for a noise the threshold is the share of the surface outside.
//! @alias threshold cut step coverage

struct Params {
    /// Values above are inside.
    /// @label Threshold @range -10 10 @soft 0 1 @default 0.5
    at: f32,
    /// Range of values around the threshold over which the border fades.
    /// @range 0 10 @soft 0 0.5 @default 0.02
    softness: f32,
}

/// 1 inside, 0 outside.
/// @input source The mask to cut. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    let t = clamp((source - params.at) / max(2.0 * params.softness, 1e-6) + 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
