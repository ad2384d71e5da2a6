//! Curve
//! Maps a mask's values through a curve that you draw.
//!
//! The curve is smooth, goes through every point and rises or falls only where the points do: it never overshoots.
//! Before the first point and after the last one it is level. Two points at the same place make a step.
//! @alias curve curves tone bend remap contrast profile
//! @use curve

struct Params {
    /// Up to sixteen points: a value of the mask, and the value it becomes.
    /// @curve @range -10 10 @soft 0 1 @default 0 0 1 1
    points: array<vec4f, 16>,
}

/// The mapped mask.
/// @input source The mask to map. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    return curve_at(params.points, source);
}
