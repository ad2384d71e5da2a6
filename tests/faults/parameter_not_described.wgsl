//! Test
//! A node with a fault.

struct Params {
    /// @default 0.5
    amount: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.amount;
}
