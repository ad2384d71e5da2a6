//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var table: array<f32, 8192>;
    table[u32(at.position.x)] = 1.0;
    return table[3];
}
