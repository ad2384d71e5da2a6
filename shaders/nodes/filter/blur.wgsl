//! Blur
//! Blurs a mask over the surface, without visible seams.
//!
//! The mask spreads like heat: the blur is the same on every unwrap and at every resolution, around corners and over every
//! seam. In texture space the radius is measured on the map instead, as paint programs do; seams stay invisible.
//! @alias soften smooth gaussian diffuse feather
//! @use heat

struct Params {
    /// Radius of the blur: the standard deviation of the Gaussian.
    /// @length @range 0 1 @soft 0 0.2 @default 0.02
    radius: f32,
    /// Whether the radius is measured on the surface or on the map.
    /// @choice surface texture @default surface
    space: u32,
}

/// How heat flows.
/// @pass 1 @texel params.radius / 4
fn conduction(at: Surface, params: Params) -> vec3f {
    return heat_conduction(at, params.space == 1u);
}

/// What is blurred.
/// @pass 2 @vector @texel params.radius / 4
/// @input source The mask to blur.
/// @type mask
fn start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The blur, on the level that suits its radius.
/// @pass 3 @vector @texel params.radius / 4
/// @repeat 4 * (2 * ceil(max(sqrt(1 + 4 * params.radius * params.radius / texel / texel) - 3, 1) / 4) + 1)
fn heat(at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, conduction: texture_2d_array<f32>) -> vec3f {
    return heat_stage(start, conduction, at, round, params.radius, params.space == 1u);
}

/// Half of the finish.
/// @pass 4
fn finish(at: Surface, round: Round, params: Params, heat: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    let state = surface_here(heat, at);
    // 0 where the coarser level has nothing near: a speck smaller than the radius.
    let center = select(surface_here(source, at).x, state.x, state.z > 0.5);
    return heat_finish(heat, at, round, params.radius, center);
}

/// The blurred mask.
fn mask(at: Surface, round: Round, params: Params, finish: texture_2d_array<f32>) -> f32 {
    return heat_finish(finish, at, round, params.radius, surface_here(finish, at).x);
}
