//! Remap
//! Stretches a mask so that one range of values becomes another.
//!
//! Values outside of the range are extrapolated; use Levels or Clamp to limit them. Where From low and From high are
//! equal there is nothing to stretch: values below become To low, all others To high.
//! @alias remap map range stretch scale offset fit math

struct Params {
    /// This value becomes To low.
    /// @range -1000 1000 @soft 0 1 @default 0
    from_low: f32,
    /// This value becomes To high.
    /// @range -1000 1000 @soft 0 1 @default 1
    from_high: f32,
    /// The result for From low.
    /// @range -1000 1000 @soft 0 1 @default 0
    to_low: f32,
    /// The result for From high. If it is below To low, the mask is inverted.
    /// @range -1000 1000 @soft 0 1 @default 1
    to_high: f32,
}

/// The stretched mask.
/// @input source The mask to stretch. @optional @default 0
fn mask(source: f32, params: Params) -> f32 {
    let span = params.from_high - params.from_low;
    let is_empty = abs(span) < 1e-6;
    let stretched = (source - params.from_low) / select(span, 1.0, is_empty);
    let step = select(0.0, 1.0, source >= params.from_low);
    return params.to_low + select(stretched, step, is_empty) * (params.to_high - params.to_low);
}
