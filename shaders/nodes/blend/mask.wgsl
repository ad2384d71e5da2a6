//! Blend masks
//! Puts one mask over another.
//!
//! Mask and Opacity fade from the mask below to the result of the mode. Values are not clamped: use Levels or Threshold to
//! bring them back to 0 to 1. Unconnected inputs are 1, which changes nothing in the mode Multiply.
//! @alias blend mix combine multiply add subtract screen overlay and or math arithmetic
//! @use blend

struct Params {
    /// How the two masks are combined.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default multiply
    mode: u32,
    /// Strength of the blend.
    /// @range 0 1 @default 1
    opacity: f32,
}

/// The blended mask.
/// @input below The mask underneath. @optional @default 1
/// @input above The mask put over it. @optional @default 1
/// @input mask Where the masks are blended. @optional @default 1
fn mask(below: f32, above: f32, mask: f32, params: Params) -> f32 {
    return blend_value(below, above, params.mode, blend_weight(mask, params.opacity));
}
