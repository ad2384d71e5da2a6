//! Test
//! A node with a fault.

/// The mask.
fn mask(at: Surface) -> f32 {
    return 1.0;
}

fn luminance(color: vec3f) -> f32 {
    return color.x;
}
