//! Smooth
//! Softens a mask slightly, without visible seams.
//!
//! Each step replaces a texel by a weighted mean of itself and its eight neighbors on the surface. The reach is counted
//! in texels, so it removes grain of the map, not detail of the model.
//! @alias smooth soften average relax
//! @use surface

struct Params {
    /// Number of steps.
    /// @range 1 64 @soft 1 16 @default 4
    steps: u32,
}

/// The softened mask.
/// @input source The mask to soften.
/// @repeat params.steps
fn mask(at: Surface, source: texture_2d_array<f32>) -> f32 {
    let center = surface_neighbor(source, at, vec2i(0, 0)).x;
    let beside = (surface_neighbor(source, at, vec2i(1, 0)).x - center)
        + (surface_neighbor(source, at, vec2i(-1, 0)).x - center)
        + (surface_neighbor(source, at, vec2i(0, 1)).x - center)
        + (surface_neighbor(source, at, vec2i(0, -1)).x - center);
    let across = (surface_neighbor(source, at, vec2i(1, 1)).x - center)
        + (surface_neighbor(source, at, vec2i(-1, 1)).x - center)
        + (surface_neighbor(source, at, vec2i(1, -1)).x - center)
        + (surface_neighbor(source, at, vec2i(-1, -1)).x - center);
    // The weights 1 2 1 both ways. A sum of differences, so that an even mask stays as it is to the last bit.
    return center + 0.125 * beside + 0.0625 * across;
}
