//! Test
//! A node with a fault.

struct Params {
    /// Whether it is on.
    /// @toggle @default on
    on: u32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    if params.on {
        return 1.0;
    }
    return 0.0;
}
