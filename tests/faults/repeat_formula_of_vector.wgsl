//! Test
//! A node with a fault.
//! @use surface

struct Params {
    /// Which way.
    /// @default 0 1 0
    toward: vec3f,
}

/// The mask.
/// @input source What it starts from.
/// @repeat ceil(params.toward / texel)
fn mask(at: Surface, source: texture_2d_array<f32>, params: Params) -> f32 {
    return here(source, at).x * params.toward.x;
}
