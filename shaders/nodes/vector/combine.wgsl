//! Combine vector
//! Makes a vector from three masks.
//!
//! @alias vector make xyz pack merge join combine position offset

/// The vector.
/// @vector
/// @input x Along the model's x axis. @optional @default 0
/// @input y Along the model's y axis, upward. @optional @default 0
/// @input z Along the model's z axis. @optional @default 0
fn vector(x: f32, y: f32, z: f32) -> vec3f {
    return vec3f(x, y, z);
}
