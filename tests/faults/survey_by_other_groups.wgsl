//! Test
//! A node with a fault.
//! @use survey

struct Params {
    /// What is measured apart.
    /// @choice whole material @default whole
    each: u32,
}

/// The lowest value.
/// @pass 1 @surveys source params.each
fn low(survey: texture_2d_array<f32>) -> f32 {
    return lowest(survey);
}

/// The mask.
/// @input source What is surveyed.
fn mask(low: f32, source: f32) -> f32 {
    return source - low;
}
