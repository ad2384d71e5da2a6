//! Plain material
//! One color, roughness and metallic everywhere: a base to age.
//!
//! @alias material base plain constant paint metal

struct Params {
    /// The color in plain light.
    /// @color @default #808080
    color: vec3f,
    /// 0 is a mirror, 1 is chalk.
    /// @range 0 1 @default 0.5
    roughness: f32,
    /// 0 is everything but metal, 1 is bare metal.
    /// @range 0 1 @default 0
    metallic: f32,
}

/// The material.
fn material(params: Params) -> Material {
    var result = plain_material();
    result.base_color = params.color;
    result.roughness = params.roughness;
    result.metallic = params.metallic;
    return result;
}
