//! Denoise
//! Removes the grain of masks made by rays, and keeps creases, borders and other details.
//!
//! Averages neighbors that face the same way and have similar values, repeatedly. Four rays with this filter look like many
//! more without it. Use Median for specks that are not grain, and Blur for softness.
//! @alias denoise grain noise smooth bilateral clean rays
//! @use surface

struct Params {
    /// Radius of the average.
    /// @length @range 0 0.1 @soft 0 0.02 @default 0.006
    radius: f32,
    /// Strength of the grain; larger differences are kept. For occlusion with 16 rays it is about 0.1.
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

/// One average, of next neighbors and of those behind them in turn: together they widen it by two and a half square texels.
/// @pass 3
/// @repeat 2 * ceil(params.radius * params.radius / texel / texel / 2.5)
fn cleaned(at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, facing: texture_2d_array<f32>) -> f32 {
    let stride = select(1, 2, (round.index & 1u) == 1u);
    let own = surface_here(start, at).x;
    let least = cos(params.angle);
    var sum = vec2f(own, 1.0) * 4.0;
    sum += counted(start, facing, at, vec2i(-1, 0) * stride, own, least, params.grain) * 2.0;
    sum += counted(start, facing, at, vec2i(1, 0) * stride, own, least, params.grain) * 2.0;
    sum += counted(start, facing, at, vec2i(0, -1) * stride, own, least, params.grain) * 2.0;
    sum += counted(start, facing, at, vec2i(0, 1) * stride, own, least, params.grain) * 2.0;
    sum += counted(start, facing, at, vec2i(-1, -1) * stride, own, least, params.grain);
    sum += counted(start, facing, at, vec2i(1, -1) * stride, own, least, params.grain);
    sum += counted(start, facing, at, vec2i(-1, 1) * stride, own, least, params.grain);
    sum += counted(start, facing, at, vec2i(1, 1) * stride, own, least, params.grain);
    return sum.x / sum.y;
}

/// The mask without grain.
fn mask(at: Surface, params: Params, cleaned: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    return select(surface_here(source, at).x, surface_here(cleaned, at).x, params.radius > 0.0);
}

// A neighbor's value and its weight.
fn counted(
    start: texture_2d_array<f32>, facing: texture_2d_array<f32>, at: Surface, step: vec2i, own: f32, least: f32,
    grain: f32,
) -> vec2f {
    let value = surface_neighbor(start, at, step).x;
    let turned = dot(at.normal, surface_neighbor(facing, at, step).xyz);
    let apart = (value - own) / grain;
    let weight = smoothstep(least - 0.001, 1.0, turned) / (1.0 + apart * apart * apart * apart);
    return vec2f(value, 1.0) * weight;
}
