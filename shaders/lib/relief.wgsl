//! How the relief that a graph has made bends.
//! @use core surface heat rays

/// The share of a half turn by which a groove of that depth turns, above 0 in grooves and below on ridges, as `bend_by`.
///
/// In a groove with straight sides, blurred with a standard deviation of half the width, the middle is higher by the
/// slope of its sides times `sqrt(1 / 2π)` of the width: its angle is exact on its line.
fn relief_bend(blurred: texture_2d_array<f32>, height: texture_2d_array<f32>, at: Surface, width: f32) -> f32 {
    let state = surface_here(blurred, at);
    let own = surface_here(height, at).x;
    let depth = select(0.0, state.x - own, state.z > 0.5);
    return 0.63661977 * atan(depth / (0.39894228 * width));
}
