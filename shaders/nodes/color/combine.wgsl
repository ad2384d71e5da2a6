//! Combine color
//! Makes a color from its channels: red, green and blue, in linear light.
//!
//! The counterpart of Split color.
//! @alias color channels rgb pack merge make join red green blue

/// The color.
/// @input red Red. @optional @default 0
/// @input green Green. @optional @default 0
/// @input blue Blue. @optional @default 0
fn color(red: f32, green: f32, blue: f32) -> vec3f {
    return max(vec3f(red, green, blue), vec3f(0.0));
}
