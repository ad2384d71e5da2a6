//! Test
//! A node with a fault.
//! @use noise

/// The mask.
fn mask(at: Surface) -> f32 {
    return waves(at.position, u32(at.position.x));
}
