//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    let t = array<f32, 100000000>();
    return t[0];
}
