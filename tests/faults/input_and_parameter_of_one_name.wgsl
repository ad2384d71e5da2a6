//! Test
//! A node with a fault.

struct Params {
    /// How much of it.
    /// @range 0 1 @default 0.5
    amount: f32,
}

/// The mask.
/// @input amount How much.
fn mask(params: Params, amount: f32) -> f32 {
    return params.amount * amount;
}
