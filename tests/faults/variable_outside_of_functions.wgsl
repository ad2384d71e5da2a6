//! Test
//! A node with a fault.

var<private> sum: f32;

/// The mask.
fn mask(at: Surface) -> f32 {
    sum += at.position.x;
    return sum;
}
