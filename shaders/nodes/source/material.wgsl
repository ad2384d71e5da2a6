//! Plain material
//! A plain base with one color, roughness and metallic value.
//!
//! @alias material base plain constant paint metal principled bsdf shader

struct Params {
    /// Base color.
    /// @color @default #808080
    color: vec3f,
    /// Roughness: 0 is a mirror, 1 is chalk.
    /// @range 0 1 @default 0.5
    roughness: f32,
    /// Metallic: 0 for anything but metal, 1 for bare metal.
    /// @range 0 1 @default 0
    metallic: f32,
    /// Share of the surface below a clear coat, as of varnish or glaze.
    /// @label Clear coat @range 0 1 @default 0
    coat: f32,
    /// Roughness of that coat: 0 is a mirror.
    /// @range 0 1 @default 0.05
    coat_roughness: f32,
}

/// The material.
fn material(params: Params) -> Material {
    var result = plain_material();
    result.base_color = params.color;
    result.roughness = params.roughness;
    result.metallic = params.metallic;
    result.coat = params.coat;
    result.coat_roughness = params.coat_roughness * sign(params.coat);
    return result;
}
