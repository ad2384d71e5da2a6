//! Clamp
//! Keeps a mask's values between two ends: what lies beyond an end becomes that end.
//!
//! @alias clamp limit cut saturate minimum maximum

struct Params {
    /// The lowest value that is left; above High, the two change places.
    /// @range -10 10 @soft 0 1 @default 0
    low: f32,
    /// The highest value that is left.
    /// @range -10 10 @soft 0 1 @default 1
    high: f32,
}

/// The clamped mask.
/// @input source The mask to clamp. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    return clamp(source, min(params.low, params.high), max(params.low, params.high));
}
