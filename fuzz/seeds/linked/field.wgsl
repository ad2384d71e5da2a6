//! Own
//! A node.

struct Params {
    /// Share.
    /// @range 0 1 @default 0.5
    share: f32,
    /// A color.
    /// @color @default 1 0.5 0
    tint: vec3f,
}

/// Color.
/// @input source What is read.
/// @input mask Where. @optional
fn color(at: Surface, source: texture_2d_array<f32>, mask: f32, params: Params) -> vec3f {
    return mix(params.tint, textureLoad(source, vec2i(0, 0), 0, 0).xyz, params.share * mask);
}
