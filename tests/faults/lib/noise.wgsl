//! A small library for the faults beside it.

/// A wave along x, with `octaves` finer ones on it.
fn waves(position: vec3f, octaves: u32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < octaves; i++) {
        sum += sin(position.x * f32(1u << min(i, 31u)));
    }
    return sum;
}
