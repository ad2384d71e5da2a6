//! Test
//! A node with a fault.

struct Params {
    /// How much of it.
    /// @range 0 1 @default 0.5
    amount: f32,
    /// How much more.
    /// @default 0
    more: f32,
}

fn helper(params: Params) -> f32 {
    let unused = params.more;
    return params.amount;
}

/// The mask.
fn mask(params: Params) -> f32 {
    return helper(params);
}
