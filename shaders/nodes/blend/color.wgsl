//! Blend colors
//! Puts one color over another.
//!
//! Mask and Opacity fade from the color below to the result of the mode, in linear light. The modes Hue, Saturation, Color
//! and Luminosity take that property from the upper color and the rest from the lower one: Color tints, Luminosity brings
//! light and shade. Values are not clamped. Unconnected, both sides are white.
//! @alias blend mix combine tint multiply add screen overlay hue saturation luminosity mixrgb
//! @use blend color

struct Params {
    /// How the two colors are combined.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// hue saturation color luminosity
    /// @default normal
    mode: u32,
    /// Strength of the blend.
    /// @range 0 1 @default 1
    opacity: f32,
}

/// The blended color.
/// @input below The color underneath. @optional @default #ffffff
/// @input above The color put over it. @optional @default #ffffff
/// @input mask Where the colors are blended. @optional @default 1
fn color(below: vec3f, above: vec3f, mask: f32, params: Params) -> vec3f {
    let weight = blend_weight(mask, params.opacity);
    if params.mode >= 12u {
        return mix(below, blend_mode_of_colors(below, above, params.mode), weight);
    }
    return blend_color(below, above, params.mode, weight);
}
