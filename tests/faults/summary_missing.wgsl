//! Test

/// The mask.
fn mask(at: Surface) -> f32 {
    return at.position.y;
}
