//! Test
//! A node with a fault.
//! @use survey surface

/// The lowest value.
/// @pass 1 @surveys source
fn low(survey: texture_2d_array<f32>) -> f32 {
    return lowest(survey);
}

/// The mask.
/// @input source What is surveyed.
fn mask(at: Surface, low: texture_2d_array<f32>, source: f32) -> f32 {
    return source - here(low, at).x;
}
