//! Clamp
//! Limits a mask to a range: values outside become the nearer end.
//!
//! @alias clamp limit cut saturate minimum maximum

struct Params {
    /// Lowest value of the result. If Low is above High, the two are swapped.
    /// @range -10 10 @soft 0 1 @default 0
    low: f32,
    /// Highest value of the result.
    /// @range -10 10 @soft 0 1 @default 1
    high: f32,
}

/// The clamped mask.
/// @input source The mask to clamp. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    return clamp(source, min(params.low, params.high), max(params.low, params.high));
}
