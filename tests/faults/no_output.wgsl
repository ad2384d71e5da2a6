//! Test
//! A node with a fault.

fn mask(at: Surface) -> f32 {
    return at.position.x;
}
