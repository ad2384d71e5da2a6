//! Test
//! A node with a fault.

struct Params {
    /// How much of it.
    /// @default 0.5
    amount: f32, // Measured on steel.
    /// How much more.
    /// @default 0.5
    more: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.amount + params.more;
}
