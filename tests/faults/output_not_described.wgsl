//! Test
//! A node with a fault.

/// @vector
fn vector(at: Surface) -> vec3f {
    return at.position;
}
