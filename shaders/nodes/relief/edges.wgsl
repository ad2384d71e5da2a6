//! Relief edges
//! The ridges and rims of the relief, which wear first.
//!
//! Like Edges, but for the relief that the graph creates: cracks, scratches, dents. A ridge counts by the angle between its
//! sides.
//! @alias wear ridge convex rim scratch micro detail
//! @use relief

struct Params {
    /// Size of the surroundings.
    /// @length @range 0.00001 1 @soft 0.001 0.05 @default 0.02
    width: f32,
    /// Smallest angle of a ridge that counts.
    /// @angle @range 0 180 @soft 1 90 @default 8
    angle: f32,
    /// How softly the mask falls off: 0 is a sharp band, 1 fades up to a right angle.
    /// @range 0 1 @default 0.5
    softness: f32,
}

/// How heat flows along u.
/// @pass 1 @vector @texel params.width / 5 @points params.width / 6
fn across(at: Surface, round: Round) -> vec3f {
    return heat_across(at, round, false);
}

/// How heat flows along v.
/// @pass 2 @vector @texel params.width / 5 @points params.width / 6
fn along(at: Surface, round: Round) -> vec3f {
    return heat_along(at, round, false);
}

/// The relief, to be smoothed.
/// @pass 3 @vector @texel params.width / 5 @points params.width / 6
/// @input height The height that the graph creates, in working units.
/// @type mask
fn start(at: Surface, height: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(height, at).x);
}

/// The smoothed relief.
/// @pass 4 @vector @texel params.width / 5 @points params.width / 6
/// @repeat max(2.55 * params.width / texel, 10.2)
fn heat(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(start, across, along, at, round, 0.5 * params.width);
}

/// 1 on ridges and rims, 0 elsewhere.
fn mask(at: Surface, params: Params, heat: texture_2d_array<f32>, height: texture_2d_array<f32>) -> f32 {
    let bend = relief_bend(heat, height, at, params.width);
    return bent_beyond(-bend, params.angle, params.softness);
}
