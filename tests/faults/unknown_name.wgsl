//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    let height = at.position.y;
    return smoothstep(0.0, 1.0, hieght);
}
