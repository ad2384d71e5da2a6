//! Light that is brighter than white.

// Light above white that counts, per channel: a lamp or the sun in the background would otherwise veil the whole picture.
const MOST_LIGHT: f32 = 16.0;

// The part of a light that is brighter than white, hue kept.
fn above_white(color: vec3f) -> vec3f {
    let peak = max(color.x, max(color.y, color.z));
    return color * (min(max(peak - 1.0, 0.0), MOST_LIGHT) / max(peak, 1.0));
}
