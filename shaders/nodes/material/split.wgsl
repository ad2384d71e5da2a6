//! Split material
//! Takes a material apart into its channels.
//!
//! The counterpart of Combine material. Use a channel as a mask, change it, and put it back.
//! @alias split material channels pbr unpack separate break extract

/// Its color in plain light.
/// @input material The material to take apart. @optional
fn base_color(material: Material) -> vec3f {
    return material.base_color;
}

/// How opaque it is: 0 is a hole.
fn alpha(material: Material) -> f32 {
    return material.alpha;
}

/// 0 is a mirror, 1 is chalk.
fn roughness(material: Material) -> f32 {
    return material.roughness;
}

/// 0 is everything but metal, 1 is bare metal.
fn metallic(material: Material) -> f32 {
    return material.metallic;
}

/// How much of the surrounding light arrives: 1 is open, 0 is buried.
fn occlusion(material: Material) -> f32 {
    return material.occlusion;
}

/// Height above the model; below 0 it is sunk in.
fn height(material: Material) -> f32 {
    return material.height;
}

/// Relief of its normal map, as a gradient on the surface. @vector
fn slope(material: Material) -> vec3f {
    return material.slope;
}

/// Light that it gives off.
fn emission(material: Material) -> vec3f {
    return material.emission;
}
