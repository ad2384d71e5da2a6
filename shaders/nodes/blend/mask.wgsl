//! Blend masks
//! Puts one mask over another.
//!
//! The result lies between what is below and what the mode makes of both, as far as Mask and Opacity let it. Values are
//! not clamped: use Levels or Threshold to bring them back to 0 to 1. Unconnected, both sides are 1, which Multiply
//! leaves alone.
//! @alias blend mix combine multiply add subtract screen overlay and or
//! @use blend

struct Params {
    /// What is made of the two masks.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default multiply
    mode: u32,
    /// How much of the result is used.
    /// @range 0 1 @default 1
    opacity: f32,
}

/// The blended mask.
/// @input below The mask underneath. @optional @default 1
/// @input above The mask put over it. @optional @default 1
/// @input mask Where the blend works. @optional @default 1
fn mask(below: f32, above: f32, mask: f32, params: Params) -> f32 {
    return blend_value(below, above, params.mode, blend_weight(mask, params.opacity));
}
