//! Test
//! A node with a fault.

struct Params {
    // Measured on steel.
    /// How much of it.
    /// @default 0.5
    amount: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.amount;
}
