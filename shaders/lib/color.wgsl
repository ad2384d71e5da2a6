//! Colors as a whole: hue, saturation and luminance, in linear light.
//! @use core

fn least_component(color: vec3f) -> f32 {
    return min(color.x, min(color.y, color.z));
}

fn greatest_component(color: vec3f) -> f32 {
    return max(color.x, max(color.y, color.z));
}

/// Pales a color toward the gray of its own luminance until all components are within `low` to `high`.
///
/// ClipColor of the W3C's "Compositing and Blending", for any ends.
fn pale_into(color: vec3f, low: f32, high: f32) -> vec3f {
    let gray = luminance(color);
    let down = max(gray - low, 0.0) / max(gray - least_component(color), 1e-9);
    let up = max(high - gray, 0.0) / max(greatest_component(color) - gray, 1e-9);
    let share = min(down, up);
    return select(clamp(gray + (color - gray) * share, vec3f(low), vec3f(high)), color, share >= 1.0);
}

/// The difference of the strongest and the weakest component.
fn saturation_of(color: vec3f) -> f32 {
    return greatest_component(color) - least_component(color);
}

/// A color of the same hue whose weakest component is 0 and whose strongest one is `saturation`; black for a gray.
fn with_saturation(color: vec3f, saturation: f32) -> vec3f {
    // The hue of a near gray is rounding error: it fades out.
    return (color - least_component(color)) * (saturation / max(saturation_of(color), 1e-4));
}

/// Result of a mode from 12 on: hue, saturation, color, luminosity of `above`, the rest of `below`.
///
/// The non-separable modes of the W3C's "Compositing and Blending Level 1" (10.2), in linear light with the luminance of
/// Rec. 709. Colors brighter than 1 may come in; then the result may be as bright.
fn blend_mode_of_colors(below: vec3f, above: vec3f, mode: u32) -> vec3f {
    let low = min(0.0, least_component(min(below, above)));
    let high = max(1.0, greatest_component(max(below, above)));
    var hued = below;
    var light = luminance(below);
    switch mode {
        case 12u: { hued = with_saturation(above, saturation_of(below)); }
        case 13u: { hued = with_saturation(below, saturation_of(above)); }
        case 14u: { hued = above; }
        default: { light = luminance(above); }
    }
    return pale_into(hued + (light - luminance(hued)), low, high);
}

/// A linear color with its hue turned by an angle in radians, its luminance kept.
///
/// Turned in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), where hues that look even lie on
/// circles and gray is the axis. The remaining change in luminance is undone by a factor.
fn turned_hue(color: vec3f, angle: f32) -> vec3f {
    let cones = vec3f(
        dot(color, vec3f(0.4122214708, 0.5363325363, 0.0514459929)),
        dot(color, vec3f(0.2119034982, 0.6806995451, 0.1073969566)),
        dot(color, vec3f(0.0883024619, 0.2817188376, 0.6299787005)),
    );
    let roots = pow(max(cones, vec3f(1e-20)), vec3f(1.0 / 3.0));
    let lightness = dot(roots, vec3f(0.2104542553, 0.7936177850, -0.0040720468));
    let a = dot(roots, vec3f(1.9779984951, -2.4285922050, 0.4505937099));
    let b = dot(roots, vec3f(0.0259040371, 0.7827717662, -0.8086757660));
    let turned_a = a * cos(angle) - b * sin(angle);
    let turned_b = a * sin(angle) + b * cos(angle);
    let turned_roots = vec3f(
        lightness + 0.3963377774 * turned_a + 0.2158037573 * turned_b,
        lightness - 0.1055613458 * turned_a - 0.0638541728 * turned_b,
        lightness - 0.0894841775 * turned_a - 1.2914855480 * turned_b,
    );
    let turned_cones = turned_roots * turned_roots * turned_roots;
    let turned = vec3f(
        dot(turned_cones, vec3f(4.0767416621, -3.3077115913, 0.2309699292)),
        dot(turned_cones, vec3f(-1.2684380046, 2.6097574011, -0.3413193965)),
        dot(turned_cones, vec3f(-0.0041960863, -0.7034186147, 1.7076147010)),
    );
    return turned * (luminance(color) / max(luminance(turned), 1e-12));
}

/// A linear color with its hue turned (radians), its saturation multiplied at the same luminance, and all of it
/// multiplied by `value`. Exactly `color` for 0, 1 and 1.
fn tuned_color(color: vec3f, hue: f32, saturation: f32, value: f32) -> vec3f {
    if hue == 0.0 && saturation == 1.0 {
        return color * value;
    }
    let source = max(color, vec3f(0.0));
    let gray = luminance(source);
    let turned = turned_hue(source, hue);
    let spread = gray + (turned - gray) * saturation;
    // Not brighter than the color given: a hue that cannot be as vivid at this luminance becomes paler.
    return pale_into(spread, 0.0, max(1.0, greatest_component(source))) * value;
}
