//! A small library for the faults beside it.

/// The stored value at this place.
fn here(source: texture_2d_array<f32>, at: Surface) -> vec4f {
    return textureLoad(source, at.texel.xy, at.texel.z, 0);
}
