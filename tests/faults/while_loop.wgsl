//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var x = at.position.x;
    while x > 0.5 {
        x *= 0.5;
    }
    return x;
}
