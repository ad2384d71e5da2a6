//! Color
//! One color everywhere.
//!
//! @alias color constant solid fill uniform flat

struct Params {
    /// The color.
    /// @color @default #808080
    color: vec3f,
}

/// The color.
fn color(params: Params) -> vec3f {
    return params.color;
}
