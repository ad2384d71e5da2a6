//! Split color
//! Splits a color into channels: red, green and blue, or hue, saturation and value.
//!
//! Packed maps hold a mask in each of red, green and blue; open them as Image with the color space raw.
//! @alias color channels rgb hsv unpack separate break extract red green blue packed orm

/// Red, in linear light.
/// @input color The color to split. @optional @default #808080
fn red(color: vec3f) -> f32 {
    return color.x;
}

/// Green, in linear light.
fn green(color: vec3f) -> f32 {
    return color.y;
}

/// Blue, in linear light.
fn blue(color: vec3f) -> f32 {
    return color.z;
}

/// Hue: 0 is red, a third is green, two thirds are blue; 0 for grays.
fn hue(color: vec3f) -> f32 {
    let most = max(color.x, max(color.y, color.z));
    let spread = most - min(color.x, min(color.y, color.z));
    if spread <= 1e-9 {
        return 0.0;
    }
    var sixth = (color.x - color.y) / spread + 4.0;
    if most == color.x {
        sixth = (color.y - color.z) / spread;
    } else if most == color.y {
        sixth = (color.z - color.x) / spread + 2.0;
    }
    return (sixth + select(0.0, 6.0, sixth < 0.0)) / 6.0;
}

/// Saturation: 0 for grays, 1 for colors in which one of red, green and blue is missing.
fn saturation(color: vec3f) -> f32 {
    let most = max(color.x, max(color.y, color.z));
    let least = min(color.x, min(color.y, color.z));
    return select(0.0, clamp((most - least) / most, 0.0, 1.0), most > 1e-9);
}

/// Value: the greatest of red, green and blue.
fn value(color: vec3f) -> f32 {
    return max(color.x, max(color.y, color.z));
}
