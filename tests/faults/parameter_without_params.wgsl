//! Test
//! A node with a fault.

struct Params {
    /// How much of it.
    /// @range 0 1 @default 0.5
    amount: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.amount * amount;
}
