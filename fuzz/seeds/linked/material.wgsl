//! Own
//! A node.

/// The material.
/// @input base Base. @optional
/// @input mask Where. @optional @default 1
fn material(at: Surface, base: Material, mask: f32) -> Material {
    var made = base;
    made.roughness = mix(base.roughness, 0.25, mask);
    return made;
}
