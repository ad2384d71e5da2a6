//! Test
//! A node with a fault.
//! @use survey

/// The mask.
/// @surveys source
/// @input source What is surveyed.
fn mask(survey: texture_2d_array<f32>, source: f32) -> f32 {
    return source * lowest(survey);
}
