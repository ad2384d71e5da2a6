//! Stands for the library of that name.

fn lowest(survey: texture_2d_array<f32>) -> f32 {
    return textureLoad(survey, vec2i(0), 0, 0).z;
}
