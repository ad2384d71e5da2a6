//! Test
//! A node with a fault.
//! @use surface

/// First.
/// @pass 1
fn first(at: Surface, second: texture_2d_array<f32>) -> f32 {
    return here(second, at).x;
}

/// Second.
/// @pass 2
fn second(at: Surface) -> f32 {
    return at.position.x;
}

/// The mask.
fn mask(at: Surface, first: texture_2d_array<f32>) -> f32 {
    return here(first, at).x;
}
