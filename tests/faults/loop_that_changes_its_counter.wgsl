//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 8; i++) {
        if at.position.x > sum {
            i -= 1;
        }
        sum += 0.1;
    }
    return sum;
}
