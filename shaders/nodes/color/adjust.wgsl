//! Adjust color
//! Changes the hue, the saturation and the brightness of a color.
//!
//! Grays stay gray. Turning the hue and changing the saturation keep the luminance; a hue that cannot be
//! as vivid at that luminance becomes paler instead of darker.
//! @alias hue saturation value brightness gamma hsv hsl colorize vibrance grade correct
//! @use color

struct Params {
    /// Turns all hues; 180 gives the opposite ones.
    /// @angle @range -180 180 @default 0
    hue: f32,
    /// 0 makes the color gray, 1 leaves it unchanged, and above 1 it becomes more vivid.
    /// @range 0 10 @soft 0 2 @default 1
    saturation: f32,
    /// Multiplies the light: 0 makes the color black, 1 leaves it unchanged.
    /// @range 0 10 @soft 0 2 @default 1
    value: f32,
    /// Above 1 brightens the middle, below 1 darkens it; black and white are not changed.
    /// @range 0.01 100 @soft 0.2 5 @default 1
    gamma: f32,
}

/// The adjusted color.
/// @input source The color to adjust. @optional @default #808080
fn color(source: vec3f, params: Params) -> vec3f {
    let tuned = tuned_color(source, params.hue, params.saturation, params.value);
    if params.gamma == 1.0 {
        return tuned;
    }
    let lit = max(tuned, vec3f(0.0));
    let light = max(luminance(lit), 1e-6);
    return pale_into(lit * pow(light, 1.0 / params.gamma - 1.0), 0.0, max(1.0, greatest_component(lit)));
}
