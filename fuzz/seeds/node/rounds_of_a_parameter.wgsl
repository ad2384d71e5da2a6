//! Own
//! A node.

struct Params {
    /// Steps.
    /// @range 1 4000000000 @default 8
    steps: u32,
}

/// The mask.
fn mask(at: Surface, params: Params) -> f32 {
    var s = 0.0;
    for (var i = 0u; i < params.steps; i++) { for (var j = 0u; j < params.steps; j++) { s += 0.1; } }
    return s;
}
