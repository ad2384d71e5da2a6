//! Pick color
//! Selects what has one color, such as a part of an ID map.
//!
//! Colors are compared as they are seen, not by their light: dark colors that look alike are alike.
//! @alias color id map select mask chroma key range picker mask from color

struct Params {
    /// The color to select.
    /// @color @default #ff0000
    target_color: vec3f,
    /// How different a color may be to be selected whole.
    /// @range 0 1 @soft 0 0.5 @default 0.05
    tolerance: f32,
    /// How much further the selection fades out.
    /// @range 0 1 @soft 0 0.5 @default 0.05
    softness: f32,
}

/// 1 where the color is the selected one, 0 where it is another.
/// @input color The colors to select from. @optional @default #808080
fn mask(color: vec3f, params: Params) -> f32 {
    let away = length(seen_color(color) - seen_color(params.target_color)) * 0.57735027;
    return 1.0 - clamp((away - params.tolerance) / max(params.softness, 1e-4), 0.0, 1.0);
}

// Components about as bright as they look: the square root is close to the encoding of sRGB.
fn seen_color(color: vec3f) -> vec3f {
    return sqrt(max(color, vec3f(0.0)));
}
