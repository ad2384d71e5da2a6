//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    var t: array<array<array<f32, 4096>, 4096>, 4096>;
    return t[0][0][0];
}
