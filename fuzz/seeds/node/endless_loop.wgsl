//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    loop { }
    return 1.0;
}
