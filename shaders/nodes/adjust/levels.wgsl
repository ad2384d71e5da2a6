//! Levels
//! Sets the black point, the white point and the brightness of the middle.
//!
//! @alias levels contrast brightness gamma range histogram math

struct Params {
    /// Values up to this one become Low.
    /// @range -10 10 @soft 0 1 @default 0
    black: f32,
    /// Values from this one on become High. If White is below Black, the mask is inverted.
    /// @range -10 10 @soft 0 1 @default 1
    white: f32,
    /// Above 1 brightens the middle, below 1 darkens it.
    /// @range 0.01 100 @soft 0.2 5 @default 1
    gamma: f32,
    /// The result for black.
    /// @range -10 10 @soft 0 1 @default 0
    low: f32,
    /// The result for white.
    /// @range -10 10 @soft 0 1 @default 1
    high: f32,
}

/// The adjusted mask.
/// @input source The mask to adjust. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    let span = params.white - params.black;
    let share = clamp((source - params.black) / select(span, 1e-6, abs(span) < 1e-6), 0.0, 1.0);
    // A power of 1 need not be exact; the default changes nothing.
    let bent = select(pow(share, 1.0 / params.gamma), share, abs(params.gamma - 1.0) < 1e-6);
    return mix(params.low, params.high, bent);
}
