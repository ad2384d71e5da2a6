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

/// How heat flows along u.
/// @pass 1 @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn across(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_across(at, round, params.space == 1u);
}

/// How heat flows along v.
/// @pass 2 @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn along(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_along(at, round, params.space == 1u);
}

/// What is blurred.
/// @pass 3 @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
/// @input source The mask to blur.
/// @type mask
fn start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The blur, on the level that suits its radius.
/// @pass 4 @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
/// @repeat max(5.1 * params.radius / texel, 10.2)
fn heat(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(start, across, along, at, round, params.radius);
}

/// The blur as one number, which is brought to the finest level.
/// @pass 5 @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn settled(at: Surface, heat: texture_2d_array<f32>) -> f32 {
    return heat_settled(heat, at);
}

/// Half of the finish.
/// @pass 6
fn finish(at: Surface, round: Round, params: Params, settled: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    let center = heat_or(settled, at, surface_here(source, at).x);
    return heat_finish(settled, at, round, params.radius, center);
}

/// How heat flows along u, for a radius of one half; on a level twice as coarse for its size, since smaller radii are only mixed.
/// @pass 7 @with radius_map @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn half_across(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_across(at, round, params.space == 1u);
}

/// How it flows along v.
/// @pass 8 @with radius_map @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn half_along(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_along(at, round, params.space == 1u);
}

/// What is blurred by one half of the radius.
/// @pass 9 @with radius_map @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn half_start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The blur of one half of the radius.
/// @pass 10 @with radius_map @vector @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
/// @repeat max(5.1 * params.radius / 2 / texel, 10.2)
fn half_heat(
    at: Surface, round: Round, params: Params, half_start: texture_2d_array<f32>, half_across: texture_2d_array<f32>,
    half_along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(half_start, half_across, half_along, at, round, params.radius / 2.0);
}

/// The blur of one half as one number.
/// @pass 11 @with radius_map @texel params.radius / 2.4 @points (1 - params.space) * params.radius / 3
fn half_settled(at: Surface, half_heat: texture_2d_array<f32>) -> f32 {
    return heat_settled(half_heat, at);
}

/// Half of its finish.
/// @pass 12 @with radius_map
fn half_finish(
    at: Surface, round: Round, params: Params, half_settled: texture_2d_array<f32>, source: texture_2d_array<f32>,
) -> f32 {
    let center = heat_or(half_settled, at, surface_here(source, at).x);
    return heat_finish(half_settled, at, round, params.radius / 2.0, center);
}

/// How heat flows along u, for a radius of one quarter.
/// @pass 13 @with radius_map @vector @texel params.radius / 4.8 @points (1 - params.space) * params.radius / 6
fn quarter_across(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_across(at, round, params.space == 1u);
}

/// How it flows along v.
/// @pass 14 @with radius_map @vector @texel params.radius / 4.8 @points (1 - params.space) * params.radius / 6
fn quarter_along(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_along(at, round, params.space == 1u);
}

/// What is blurred by one quarter of the radius.
/// @pass 15 @with radius_map @vector @texel params.radius / 4.8 @points (1 - params.space) * params.radius / 6
fn quarter_start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The blur of one quarter of the radius.
/// @pass 16 @with radius_map @vector @texel params.radius / 4.8 @points (1 - params.space) * params.radius / 6
/// @repeat max(5.1 * params.radius / 4 / texel, 10.2)
fn quarter_heat(
    at: Surface, round: Round, params: Params, quarter_start: texture_2d_array<f32>, quarter_across: texture_2d_array<f32>,
    quarter_along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(quarter_start, quarter_across, quarter_along, at, round, params.radius / 4.0);
}

/// The blur of one quarter as one number.
/// @pass 17 @with radius_map @texel params.radius / 4.8 @points (1 - params.space) * params.radius / 6
fn quarter_settled(at: Surface, quarter_heat: texture_2d_array<f32>) -> f32 {
    return heat_settled(quarter_heat, at);
}

/// Half of its finish.
/// @pass 18 @with radius_map
fn quarter_finish(
    at: Surface, round: Round, params: Params, quarter_settled: texture_2d_array<f32>, source: texture_2d_array<f32>,
) -> f32 {
    let center = heat_or(quarter_settled, at, surface_here(source, at).x);
    return heat_finish(quarter_settled, at, round, params.radius / 4.0, center);
}

/// How heat flows along u, for a radius of one eighth.
/// @pass 19 @with radius_map @vector @texel params.radius / 9.6 @points (1 - params.space) * params.radius / 12
fn eighth_across(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_across(at, round, params.space == 1u);
}

/// How it flows along v.
/// @pass 20 @with radius_map @vector @texel params.radius / 9.6 @points (1 - params.space) * params.radius / 12
fn eighth_along(at: Surface, round: Round, params: Params) -> vec3f {
    return heat_along(at, round, params.space == 1u);
}

/// What is blurred by one eighth of the radius.
/// @pass 21 @with radius_map @vector @texel params.radius / 9.6 @points (1 - params.space) * params.radius / 12
fn eighth_start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The blur of one eighth of the radius.
/// @pass 22 @with radius_map @vector @texel params.radius / 9.6 @points (1 - params.space) * params.radius / 12
/// @repeat max(5.1 * params.radius / 8 / texel, 10.2)
fn eighth_heat(
    at: Surface, round: Round, params: Params, eighth_start: texture_2d_array<f32>, eighth_across: texture_2d_array<f32>,
    eighth_along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(eighth_start, eighth_across, eighth_along, at, round, params.radius / 8.0);
}

/// The blur of one eighth as one number.
/// @pass 23 @with radius_map @texel params.radius / 9.6 @points (1 - params.space) * params.radius / 12
fn eighth_settled(at: Surface, eighth_heat: texture_2d_array<f32>) -> f32 {
    return heat_settled(eighth_heat, at);
}

/// Half of its finish.
/// @pass 24 @with radius_map
fn eighth_finish(
    at: Surface, round: Round, params: Params, eighth_settled: texture_2d_array<f32>, source: texture_2d_array<f32>,
) -> f32 {
    let center = heat_or(eighth_settled, at, surface_here(source, at).x);
    return heat_finish(eighth_settled, at, round, params.radius / 8.0, center);
}

// The second half of a finish.
fn finished(finish: texture_2d_array<f32>, at: Surface, round: Round, radius: f32) -> f32 {
    return heat_finish(finish, at, round, radius, surface_here(finish, at).x);
}

/// The blurred mask.
/// @input radius_map Multiplies the radius at each place: 0 leaves the mask as it is, 1 is the whole radius. @optional @default 1
fn mask(
    at: Surface,
    round: Round,
    params: Params,
    finish: texture_2d_array<f32>,
    half_finish: texture_2d_array<f32>,
    quarter_finish: texture_2d_array<f32>,
    eighth_finish: texture_2d_array<f32>,
    source: texture_2d_array<f32>,
    radius_map: f32,
) -> f32 {
    let whole = finished(finish, at, round, params.radius);
    let share = clamp(radius_map, 0.0, 1.0);
    if share >= 1.0 {
        return whole;
    }
    // Between two blurs by variance: the mixture of two Gaussians has exactly the variance in between.
    let steps = clamp((share * share - vec4f(0.0, 1.0, 4.0, 16.0) / 64.0) / (vec4f(1.0, 3.0, 12.0, 48.0) / 64.0), vec4f(0.0), vec4f(1.0));
    var result = mix(surface_here(source, at).x, finished(eighth_finish, at, round, params.radius / 8.0), steps.x);
    result = mix(result, finished(quarter_finish, at, round, params.radius / 4.0), steps.y);
    result = mix(result, finished(half_finish, at, round, params.radius / 2.0), steps.z);
    return mix(result, whole, steps.w);
}
