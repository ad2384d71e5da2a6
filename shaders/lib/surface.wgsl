//! How a field node reads stored results on the surface.
//!
//! Steps are texels of the chart at hand. Two texels in any direction are valid at every place: over a seam the
//! atlas keeps ghost texels, refreshed before each read, that hold what lies straight ahead on the other side.

/// The stored value `step` texels away, at most two in each direction.
fn surface_neighbor(source: texture_2d_array<f32>, at: Surface, step: vec2i) -> vec4f {
    return textureLoad(source, at.texel.xy + clamp(step, vec2i(-2), vec2i(2)), at.texel.z, 0);
}

/// The stored value at this place.
fn surface_here(source: texture_2d_array<f32>, at: Surface) -> vec4f {
    return textureLoad(source, at.texel.xy, at.texel.z, 0);
}
