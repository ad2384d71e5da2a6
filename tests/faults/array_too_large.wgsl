//! Array too large
//! A table that every texel would have a copy of.

/// The mask.
fn mask(at: Surface) -> f32 {
    let table = array<f32, 100000000>();
    return table[u32(at.uv.x)];
}
