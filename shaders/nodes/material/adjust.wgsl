//! Adjust material
//! Changes the color, the surface and the relief of a material, where a mask is above 0.
//!
//! Grays stay gray, and turning the hue keeps the luminance, as in Adjust color. With all parameters at their defaults the
//! material is exactly unchanged.
//! @alias adjust material hue saturation value brightness wet worn faded grade correct strength normal
//! @use blend color

struct Params {
    /// Turns all hues; 180 gives the opposite ones.
    /// @angle @range -180 180 @default 0
    hue: f32,
    /// 0 makes the color gray, 1 leaves it unchanged, and above 1 it becomes more vivid.
    /// @range 0 10 @soft 0 2 @default 1
    saturation: f32,
    /// Multiplies the color's light: 0 makes it black, 1 leaves it unchanged.
    /// @range 0 10 @soft 0 2 @default 1
    value: f32,
    /// Added to the roughness: below 0 makes the material glossy, above 0 dull.
    /// @range -1 1 @default 0
    roughness: f32,
    /// Multiplies the roughness, before Roughness is added.
    /// @range 0 10 @soft 0 2 @default 1
    roughness_scale: f32,
    /// Added to the metallic value.
    /// @range -1 1 @default 0
    metallic: f32,
    /// Added to the height: below 0 sinks the material.
    /// @length @range -100 100 @soft -0.05 0.05 @default 0
    height: f32,
    /// Multiplies the height, before Height is added: 0 is flat, below 0 turns hills into hollows.
    /// @range -10 10 @soft 0 2 @default 1
    height_scale: f32,
    /// Multiplies the relief of the model's own normal map.
    /// @label Normal map @range -10 10 @soft 0 2 @default 1
    slope_scale: f32,
    /// Strength of the change.
    /// @range 0 1 @default 1
    opacity: f32,
}

/// The changed material.
/// @input material The material to change. @optional
/// @input mask Where the material is changed. @optional @default 1
fn material(material: Material, mask: f32, params: Params) -> Material {
    let weight = blend_weight(mask, params.opacity);
    let tuned = tuned_color(material.base_color, params.hue, params.saturation, params.value);
    // What is added is 0 where nothing changes: a mix of two equal values need not be that value.
    let roughness = material.roughness * (params.roughness_scale - 1.0) + params.roughness;
    let height = material.height * (params.height_scale - 1.0) + params.height;
    var result = material;
    result.base_color = material.base_color + (tuned - material.base_color) * weight;
    result.roughness = clamp(material.roughness + roughness * weight, 0.0, 1.0);
    result.metallic = clamp(material.metallic + params.metallic * weight, 0.0, 1.0);
    result.height = material.height + height * weight;
    result.slope = material.slope + material.slope * ((params.slope_scale - 1.0) * weight);
    return result;
}
