//! Blend colors
//! Puts one color over another.
//!
//! The result lies between what is below and what the mode makes of both, in linear light, as far as Mask and Opacity let
//! it. Hue, Saturation, Color and Luminosity take that from the upper color and the rest from the lower one: Color tints,
//! Luminosity lends light and shade. Values are not clamped. Unconnected, both sides are white.
//! @alias blend mix combine tint multiply add screen overlay hue saturation luminosity
//! @use blend color

struct Params {
    /// What is made of the two colors.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// hue saturation color luminosity
    /// @default normal
    mode: u32,
    /// How much of the result is used.
    /// @range 0 1 @default 1
    opacity: f32,
}

/// The blended color.
/// @input below The color underneath. @optional @default #ffffff
/// @input above The color put over it. @optional @default #ffffff
/// @input mask Where the blend works. @optional @default 1
fn color(below: vec3f, above: vec3f, mask: f32, params: Params) -> vec3f {
    let weight = blend_weight(mask, params.opacity);
    if params.mode >= 12u {
        return mix(below, blend_mode_of_colors(below, above, params.mode), weight);
    }
    return blend_color(below, above, params.mode, weight);
}
