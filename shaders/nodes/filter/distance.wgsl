//! Distance
//! A mask that fades with the distance from another mask, over the surface and around corners.
//!
//! The distance is that of the shortest path over the surface, not through the air: it does not jump from one leg of a chair
//! to the next.
//! @alias gradient falloff glow outline halo geodesic
//! @use distance

struct Params {
    /// Distance at which the mask has faded out.
    /// @length @range 0.0001 2 @soft 0.005 0.3 @default 0.05
    width: f32,
    /// Values of the mask above this one are inside.
    /// @range 0 1 @default 0.5
    threshold: f32,
}

/// Where the mask's border passes.
/// @pass 1
/// @input source The mask to measure from.
fn border(at: Surface, params: Params, source: texture_2d_array<f32>) -> f32 {
    return distance_start(source, at, params.threshold, 1.0, 1.1 * params.width);
}

/// How far it is, close by.
/// @pass 2 @repeat ceil(3.5 * max(min(params.width / 16, 16 * finest), finest) / finest) + 4
fn close(at: Surface, border: texture_2d_array<f32>) -> f32 {
    return distance_sweep(border, at);
}

/// The same on a level that has some twenty texels for the whole way.
/// @pass 3 @texel min(params.width / 16, 16 * finest)
fn seed(at: Surface, close: texture_2d_array<f32>) -> f32 {
    return surface_here(close, at).x;
}

/// How far it is from everywhere.
/// @pass 4 @texel min(params.width / 16, 16 * finest)
/// @repeat ceil(1.3 * params.width / texel) + 8
fn far(at: Surface, seed: texture_2d_array<f32>) -> f32 {
    return distance_sweep(seed, at);
}

/// 1 on the mask, falling to 0 with the distance from it.
fn mask(at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>) -> f32 {
    return 1.0 - clamp(away(at, round, params, close, far) / params.width, 0.0, 1.0);
}

/// Distance to the mask; at most Width.
fn distance(at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>) -> f32 {
    return min(away(at, round, params, close, far), params.width);
}

fn away(at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>) -> f32 {
    return distance_known(close, far, at, clamp(params.width / 16.0, round.finest, 16.0 * round.finest));
}
