//! Test
//! A node with a fault.

struct Params {
    /// Where the model begins.
    /// @extent low amount
    low: f32,
    /// How much of it.
    /// @range 0 1 @default 0.5
    amount: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.low + params.amount;
}
