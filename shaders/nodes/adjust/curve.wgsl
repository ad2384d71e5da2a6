//! Curve
//! Bends a mask's values along a curve through points of your choice.
//!
//! The curve is smooth, goes through every point and rises or falls only where the points do: it never overshoots.
//! Before the first point and behind the last one it is held. Two points at the same place make a step.
//! @alias curve curves tone bend remap contrast profile
//! @use curve

struct Params {
    /// Up to sixteen points: the mask's value and what becomes of it.
    /// @curve @range -10 10 @soft 0 1 @default 0 0 1 1
    points: array<vec4f, 16>,
}

/// The bent mask.
/// @input source The mask to bend. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    return curve_at(params.points, source);
}
