//! Warp
//! Moves a mask along the surface, up the slopes of another mask: bends straight borders and blends patterns.
//! @alias distort displace bend deform melt
//! @use slope

struct Params {
    /// Largest distance of the movement.
    /// @length @range -1 1 @soft -0.1 0.1 @default 0.02
    distance: f32,
}

/// The slopes that it follows, without detail that is small against the way.
/// @pass 1 @vector @texel abs(params.distance) / 8
/// @input by The mask whose slopes move the source: the steeper, the further.
/// @type mask
fn slope(at: Surface, by: texture_2d_array<f32>) -> vec3f {
    return surface_gradient(by, at);
}

/// The moved mask.
/// @input source The mask to move.
fn mask(at: Surface, params: Params, source: texture_2d_array<f32>, slope: texture_2d_array<f32>) -> f32 {
    let way = slope_way(surface_here(slope, at).xyz, params.distance);
    return surface_sample(source, surface_walk(surface_standing(at), way)).x;
}
