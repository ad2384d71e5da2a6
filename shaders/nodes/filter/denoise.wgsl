//! Denoise
//! Removes the grain of a mask, and keeps creases, borders and other details.
//!
//! Averages neighbors that face the same way and have similar values, repeatedly; wide radii on a coarser level, so
//! that they take no longer than small ones. Most masks made by rays have no grain; those of Sunlight, Rain and Contact have,
//! and so have scans. Use Median for specks that are not grain, and Blur for softness.
//! @alias denoise grain noise smooth bilateral clean rays
//! @use surface

struct Params {
    /// Radius of the average.
    /// @length @range 0 0.1 @soft 0 0.02 @default 0.006
    radius: f32,
    /// Strength of the grain; larger differences are kept. For sunlight with 16 rays it is about 0.1.
    /// @range 0.001 1 @default 0.15
    grain: f32,
    /// Largest angle between the normals of neighbors that are averaged.
    /// @angle @range 1 180 @soft 5 60 @default 20
    angle: f32,
}

/// The normal of each place.
/// @pass 1 @vector
fn facing(at: Surface) -> vec3f {
    return at.normal;
}

/// The mask to filter.
/// @pass 2
/// @input source The mask with grain.
fn start(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return surface_here(source, at).x;
}

/// One average of near neighbors. Wide radii need few of these: they only take the worst of the grain away before the mask
/// moves to a coarser level, where the same radius has fewer texels.
/// @pass 3
/// @repeat 2 * ceil(min(params.radius * params.radius / texel / texel / 2.5, 3))
fn near(at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, facing: texture_2d_array<f32>) -> f32 {
    return averaged(start, facing, at, round, params);
}

/// The normal of each place of the coarser level.
/// @pass 4 @vector @texel params.radius / 6
fn wide_facing(at: Surface) -> vec3f {
    return at.normal;
}

/// The mask on the coarser level, 0, and 1.
/// @pass 5 @vector @texel params.radius / 6
fn wide_start(at: Surface, near: texture_2d_array<f32>) -> vec3f {
    return vec3f(surface_here(near, at).x, 0.0, 1.0);
}

/// One average on the coarser level.
/// @pass 6 @vector @texel params.radius / 6
/// @repeat 2 * ceil(params.radius * params.radius / texel / texel / 2.5)
fn wide(
    at: Surface, round: Round, params: Params, wide_start: texture_2d_array<f32>, wide_facing: texture_2d_array<f32>,
) -> vec3f {
    return vec3f(averaged(wide_start, wide_facing, at, round, params), 0.0, 1.0);
}

/// The mask without grain.
fn mask(
    at: Surface, params: Params, near: texture_2d_array<f32>, wide: texture_2d_array<f32>, source: texture_2d_array<f32>,
) -> f32 {
    let detail = surface_here(near, at).x;
    let smoothed = surface_here(wide, at);
    // What differs by more than the grain is a detail that the coarser level has lost. Where that level has nothing near, the
    // third value is 0.
    let apart = (smoothed.x - detail) / params.grain;
    let weight = select(0.0, 1.0 / (1.0 + pow4(2.0 * apart)), smoothed.z > 0.5);
    return select(surface_here(source, at).x, mix(detail, smoothed.x, weight), params.radius > 0.0);
}

// An average of next neighbors and, in every second round, of those behind them: two rounds widen it by two and a half square
// texels.
fn averaged(
    state: texture_2d_array<f32>, facing: texture_2d_array<f32>, at: Surface, round: Round, params: Params,
) -> f32 {
    let stride = select(1, 2, (round.index & 1u) == 1u);
    let own = surface_here(state, at).x;
    let least = cos(params.angle);
    var sum = vec2f(own, 1.0) * 4.0;
    sum += counted(state, facing, at, vec2i(-1, 0) * stride, own, least, params.grain) * 2.0;
    sum += counted(state, facing, at, vec2i(1, 0) * stride, own, least, params.grain) * 2.0;
    sum += counted(state, facing, at, vec2i(0, -1) * stride, own, least, params.grain) * 2.0;
    sum += counted(state, facing, at, vec2i(0, 1) * stride, own, least, params.grain) * 2.0;
    sum += counted(state, facing, at, vec2i(-1, -1) * stride, own, least, params.grain);
    sum += counted(state, facing, at, vec2i(1, -1) * stride, own, least, params.grain);
    sum += counted(state, facing, at, vec2i(-1, 1) * stride, own, least, params.grain);
    sum += counted(state, facing, at, vec2i(1, 1) * stride, own, least, params.grain);
    return sum.x / sum.y;
}

// A neighbor's value and its weight.
fn counted(
    state: texture_2d_array<f32>, facing: texture_2d_array<f32>, at: Surface, step: vec2i, own: f32, least: f32,
    grain: f32,
) -> vec2f {
    let value = surface_neighbor(state, at, step).x;
    let turned = dot(at.normal, surface_neighbor(facing, at, step).xyz);
    let apart = (value - own) / grain;
    let weight = smoothstep(least - 0.001, 1.0, turned) / (1.0 + pow4(apart));
    return vec2f(value, 1.0) * weight;
}

fn pow4(x: f32) -> f32 {
    return x * x * x * x;
}
