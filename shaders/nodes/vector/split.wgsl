//! Split vector
//! Splits a vector into three masks, which may be below 0 and above 1.
//!
//! @alias vector xyz unpack separate break extract components

/// Along the model's x axis.
/// @input vector The vector to split. @vector @optional @default 0 0 0
fn x(vector: vec3f) -> f32 {
    return vector.x;
}

/// Along the model's y axis, upward.
fn y(vector: vec3f) -> f32 {
    return vector.y;
}

/// Along the model's z axis.
fn z(vector: vec3f) -> f32 {
    return vector.z;
}
