//! Combine material
//! Makes a material from its channels, each of them connected or set by hand.
//!
//! The counterpart of Split material: a material that is split and combined again is unchanged.
//! @alias combine material channels pbr pack merge make join

/// The material.
/// @input base_color Base color. @optional @default #808080
/// @input alpha Opacity: 0 is a hole. @optional @default 1
/// @input roughness Roughness: 0 is a mirror, 1 is chalk. @optional @default 0.7
/// @input metallic Metallic: 0 for anything but metal, 1 for bare metal. @optional @default 0
/// @input occlusion Share of the surrounding light that arrives: 1 is open, 0 is buried. @optional @default 1
/// @input height Height above the model; below 0 is sunk in. @optional @default 0
/// @input slope Relief of a normal map, as Split material gives it. @vector @optional @default 0 0 0
/// @input emission Emitted light. @optional @default #000000
/// @input coat Share of the surface below a clear coat, as of varnish or glaze. @optional @default 0
/// @input coat_roughness Roughness of that coat: 0 is a mirror. @optional @default 0
/// @input anisotropy Direction of fine scratches, with their strength as its length; highlights are drawn out across it. @vector @optional @default 0 0 0
/// @input sheen Color of the soft light at grazing angles, as of cloth. @optional @default #000000
/// @input sheen_roughness How far that light reaches from there. @optional @default 0
/// @input subsurface Share of the light that spreads below the surface, as in wax or marble. @optional @default #000000
/// @input transmission Share of the light that goes through, as through thin glass. @optional @default 0
fn material(
    base_color: vec3f,
    alpha: f32,
    roughness: f32,
    metallic: f32,
    occlusion: f32,
    height: f32,
    slope: vec3f,
    emission: vec3f,
    coat: f32,
    coat_roughness: f32,
    anisotropy: vec3f,
    sheen: vec3f,
    sheen_roughness: f32,
    subsurface: vec3f,
    transmission: f32,
) -> Material {
    return Material(
        max(base_color, vec3f(0.0)),
        clamp(alpha, 0.0, 1.0),
        clamp(roughness, 0.0, 1.0),
        clamp(metallic, 0.0, 1.0),
        clamp(occlusion, 0.0, 1.0),
        height,
        slope,
        max(emission, vec3f(0.0)),
        clamp(coat, 0.0, 1.0),
        clamp(coat_roughness, 0.0, 1.0),
        anisotropy,
        clamp(sheen, vec3f(0.0), vec3f(1.0)),
        clamp(sheen_roughness, 0.0, 1.0),
        clamp(subsurface, vec3f(0.0), vec3f(1.0)),
        clamp(transmission, 0.0, 1.0),
    );
}
