//! Test
//! A node with a fault.

struct Params {
    /// How often.
    /// @range 1 100 @default 4
    steps: u32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    var more = params;
    more.steps = 1000000u;
    return f32(more.steps);
}
