//! Test
//! A node with a fault.

@compute @workgroup_size(8)
fn main() {
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.x;
}
