//! Split material
//! Splits a material into its channels.
//!
//! The counterpart of Combine material. Use a channel as a mask, change it, and put it back.
//! @alias split material channels pbr unpack separate break extract

/// Base color.
/// @input material The material to split. @optional
fn base_color(material: Material) -> vec3f {
    return material.base_color;
}

/// Opacity: 0 is a hole.
fn alpha(material: Material) -> f32 {
    return material.alpha;
}

/// Roughness: 0 is a mirror, 1 is chalk.
fn roughness(material: Material) -> f32 {
    return material.roughness;
}

/// Metallic: 0 for anything but metal, 1 for bare metal.
fn metallic(material: Material) -> f32 {
    return material.metallic;
}

/// Share of the surrounding light that arrives: 1 is open, 0 is buried.
fn occlusion(material: Material) -> f32 {
    return material.occlusion;
}

/// Height above the model; below 0 is sunk in.
fn height(material: Material) -> f32 {
    return material.height;
}

/// Relief of the normal map, as a gradient on the surface. @vector
fn slope(material: Material) -> vec3f {
    return material.slope;
}

/// Emitted light.
fn emission(material: Material) -> vec3f {
    return material.emission;
}

/// Share of the surface below a clear coat.
fn coat(material: Material) -> f32 {
    return material.coat;
}

/// Roughness of the clear coat: 0 is a mirror.
fn coat_roughness(material: Material) -> f32 {
    return material.coat_roughness;
}

/// Direction of fine scratches, with their strength as its length. @vector
fn anisotropy(material: Material) -> vec3f {
    return material.anisotropy;
}

/// Color of the soft light at grazing angles.
fn sheen(material: Material) -> vec3f {
    return material.sheen;
}

/// How far the sheen reaches from grazing angles.
fn sheen_roughness(material: Material) -> f32 {
    return material.sheen_roughness;
}

/// Share of the light that spreads below the surface.
fn subsurface(material: Material) -> vec3f {
    return material.subsurface;
}

/// Share of the light that goes through.
fn transmission(material: Material) -> f32 {
    return material.transmission;
}
