//! Sharpen
//! Sharpens a mask: more contrast at borders and in details.
//! @alias unsharp crisp detail contrast highpass
//! @use heat

struct Params {
    /// Radius of the surroundings that each place is compared with.
    /// @length @range 0 1 @soft 0 0.1 @default 0.01
    radius: f32,
    /// Strength: how much of the difference to the surroundings is added.
    /// @range 0 10 @soft 0 3 @default 1
    amount: f32,
}

/// How heat flows along u.
/// @pass 1 @vector @texel params.radius / 2.4 @points params.radius / 3
fn across(at: Surface, round: Round) -> vec3f {
    return heat_across(at, round, false);
}

/// How heat flows along v.
/// @pass 2 @vector @texel params.radius / 2.4 @points params.radius / 3
fn along(at: Surface, round: Round) -> vec3f {
    return heat_along(at, round, false);
}

/// What is blurred.
/// @pass 3 @vector @texel params.radius / 2.4 @points params.radius / 3
/// @input source The mask to sharpen.
/// @type mask
fn start(at: Surface, source: texture_2d_array<f32>) -> vec3f {
    return heat_start(surface_here(source, at).x);
}

/// The surroundings.
/// @pass 4 @vector @texel params.radius / 2.4 @points params.radius / 3
/// @repeat max(5.1 * params.radius / texel, 10.2)
fn heat(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
) -> vec3f {
    return heat_stage(start, across, along, at, round, params.radius);
}

/// The surroundings as one number, which is brought to the finest level.
/// @pass 5 @texel params.radius / 2.4 @points params.radius / 3
fn settled(at: Surface, heat: texture_2d_array<f32>) -> f32 {
    return heat_settled(heat, at);
}

/// Half of their finish.
/// @pass 6
fn finish(at: Surface, round: Round, params: Params, settled: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    let center = heat_or(settled, at, surface_here(source, at).x);
    return heat_finish(settled, at, round, params.radius, center);
}

/// The sharpened mask; it may reach below 0 and above 1.
fn mask(at: Surface, round: Round, params: Params, finish: texture_2d_array<f32>, source: texture_2d_array<f32>) -> f32 {
    let around = heat_finish(finish, at, round, params.radius, surface_here(finish, at).x);
    let own = surface_here(source, at).x;
    return own + params.amount * (own - around);
}
