//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    var t: array<array<f32, 64>, 64>;
    return t[u32(at.uv.x * 60.0)][3];
}
