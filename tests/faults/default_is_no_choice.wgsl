//! Test
//! A node with a fault.

struct Params {
    /// What it does.
    /// @choice add multiply screen @default mulitply
    mode: u32,
}

/// The mask.
fn mask(params: Params) -> f32 {
    return f32(params.mode);
}
