//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var table: array<vec4f, 2048>;
    table[u32(at.position.x)] = vec4f(1.0);
    return table[3].x;
}
