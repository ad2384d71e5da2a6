//! Places that a material leaves clear: in the mean of the samples, as many points of them as its alpha says.
//! @use view/maps view/switches

// A share of 0..1 for a pixel, another one in each sample: veils are as dense as they should be in the mean.
fn veil(pixel: vec2f, sample: f32) -> f32 {
    // Interleaved gradient noise (Jimenez 2014, "Next generation post processing in Call of Duty").
    let moved = pixel + 5.588238 * sample;
    return fract(52.9829189 * fract(dot(moved, vec2f(0.06711056, 0.00583715))));
}

fn is_clear(place: Place, pixel: vec2f, sample: f32) -> bool {
    let alpha = select(material.color.w, value_at(colors, place).w, has_map(COLOR_MAP));
    // One condition, see `switches.wgsl`: without a map, the first half asks a uniform buffer alone.
    return (alpha < 1.0) & (alpha <= veil(pixel, sample));
}
