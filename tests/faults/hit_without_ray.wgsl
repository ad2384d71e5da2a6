//! Test
//! A node with a fault.
//! @use rays

/// The mask.
fn mask(hit: Hit) -> f32 {
    return hit.distance;
}
