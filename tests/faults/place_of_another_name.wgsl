//! Test
//! A node with a fault.

/// The mask.
fn mask(place: Surface) -> f32 {
    return place.position.x;
}
