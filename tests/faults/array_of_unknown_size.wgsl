//! Array of unknown size
//! The size is computed in a way that the reader does not follow.

const SIZE = max(4, 8);

/// The mask.
fn mask(at: Surface) -> f32 {
    var table: array<f32, SIZE>;
    table[u32(at.uv.x)] = 1.0;
    return table[0];
}
