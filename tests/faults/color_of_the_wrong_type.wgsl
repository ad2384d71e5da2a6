//! Test
//! A node with a fault.

struct Params {
    /// Its color.
    /// @color @default #808080
    amount: f32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return params.amount;
}
