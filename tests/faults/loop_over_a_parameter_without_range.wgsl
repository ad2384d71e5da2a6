//! Test
//! A node with a fault.

struct Params {
    /// How often.
    /// @default 4
    steps: u32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < params.steps; i++) {
        sum += 0.1;
    }
    return sum;
}
