//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    workgroupBarrier();
    return at.position.x;
}
