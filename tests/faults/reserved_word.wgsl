//! Test
//! A node with a fault.

struct Params {
    /// Where it starts.
    /// @default 0
    from: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.from;
}
