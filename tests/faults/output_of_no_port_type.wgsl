//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> vec2f {
    return at.uv;
}
