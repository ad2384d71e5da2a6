//! Test
//! A node with a fault.

struct Params {
    /// How often.
    /// @range 1 100 @default 4
    steps: u32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < params.steps; i++) {
        for (var j = 0u; j < params.steps; j++) {
            for (var k = -3; k <= 3; k++) {
                sum += 0.1;
            }
        }
    }
    return sum;
}
