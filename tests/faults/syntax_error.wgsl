//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    let x = at.position.x
    return x;
}
