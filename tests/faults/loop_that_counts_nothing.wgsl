//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 8; sum += 1.0) {
        sum += at.position.x;
    }
    return sum;
}
