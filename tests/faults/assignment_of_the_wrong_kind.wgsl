//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var x = 1.0;
    x = at.uv;
    return x;
}
