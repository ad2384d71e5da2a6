//! Grow
//! Grows or shrinks a mask by a length on the surface.
//! @alias dilate erode expand contract shrink spread outline
//! @use distance

struct Params {
    /// Distance by which the mask grows; below 0 it shrinks.
    /// @length @range -1 1 @soft -0.1 0.1 @default 0.01
    radius: f32,
    /// Values of the mask above this one are inside.
    /// @range 0 1 @default 0.5
    threshold: f32,
}

// 1 to grow, -1 to shrink.
fn side(params: Params) -> f32 {
    return select(-1.0, 1.0, params.radius >= 0.0);
}

/// Where the mask's border passes.
/// @pass 1
/// @input source The mask to grow.
fn border(at: Surface, params: Params, source: texture_2d_array<f32>) -> f32 {
    return distance_start(source, at, params.threshold, side(params), 1.1 * abs(params.radius) + 3.0 * at.texel_size);
}

/// How far it is, close by.
/// @pass 2 @repeat ceil(3.5 * max(min(abs(params.radius) / 16, 16 * finest), finest) / finest) + 4
fn close(at: Surface, border: texture_2d_array<f32>) -> f32 {
    return distance_sweep(border, at);
}

/// The same on a level that has some twenty texels for the whole way.
/// @pass 3 @texel min(abs(params.radius) / 16, 16 * finest)
fn seed(at: Surface, close: texture_2d_array<f32>) -> f32 {
    return surface_here(close, at).x;
}

/// How far it is from everywhere.
/// @pass 4 @texel min(abs(params.radius) / 16, 16 * finest)
/// @repeat ceil(1.3 * abs(params.radius) / texel) + 8
fn far(at: Surface, seed: texture_2d_array<f32>) -> f32 {
    return distance_sweep(seed, at);
}

/// Width of the texels of that level.
/// @pass 5 @texel min(abs(params.radius) / 16, 16 * finest)
fn coarse(at: Surface, round: Round) -> f32 {
    return round.texel;
}

/// The grown mask.
/// @input radius_map Multiplies the radius at each place: 0 leaves the mask as it is, 1 is the whole radius. @optional @default 1
fn mask(
    at: Surface,
    round: Round,
    params: Params,
    close: texture_2d_array<f32>,
    far: texture_2d_array<f32>,
    coarse: texture_2d_array<f32>,
    source: texture_2d_array<f32>,
    radius_map: f32,
) -> f32 {
    let reach = clamp(abs(params.radius) / 16.0, round.finest, 16.0 * round.finest);
    let away = distance_known(close, far, coarse, at, reach);
    // What was inside stays so; the new border is as soft as a texel is wide.
    let inside = (surface_here(source, at).x - params.threshold) * side(params) >= 0.0;
    let radius = abs(params.radius) * clamp(radius_map, 0.0, 1.0);
    let covered = select(clamp((radius - away) / at.texel_size + 0.5, 0.0, 1.0), 1.0, inside);
    return select(1.0 - covered, covered, params.radius >= 0.0);
}
