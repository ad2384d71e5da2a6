//! Test
//! A node with a fault.

struct Params {
    /// Whether it is on.
    /// @toggle @default on
    on: bool,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return select(0.0, 1.0, params.on);
}
