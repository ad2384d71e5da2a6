//! Plume
//! Smoke and soot that rise from a mask over the surface, widen and break up: above windows, burners, exhausts, candles.
//!
//! Soot settles on walls and below ceilings; where the surface faces up, smoke leaves it. It does not cross from one separate
//! piece of the model to the next.
//! @alias plume smoke soot fire heat exhaust burn chimney steam scorch rise black
//! @use surface noise

struct Params {
    /// Direction in which it rises, in model space.
    /// @default 0 1 0
    toward: vec3f,
    /// Distance that it rises.
    /// @length @range 0.0001 4 @soft 0.02 1 @default 0.4
    rise: f32,
    /// How much it widens on its way.
    /// @range 0 1 @default 0.4
    spread: f32,
    /// How much it swirls and breaks up.
    /// @range 0 1 @default 0.5
    turbulence: f32,
    /// Number that chooses the swirls.
    /// @seed @default 0
    seed: u32,
}

/// Velocity of the smoke, at most about 1.
/// @pass 1 @vector @texel params.rise / 44
fn way(at: Surface, params: Params) -> vec3f {
    let up = up_of(params);
    let upright = dot(up, at.face_normal);
    let along = up - at.face_normal * upright;
    let across = cross(at.face_normal, unit_or(along, vec3f(0.0)));
    let key = seed_key(params.seed);
    let place = at.position / (0.2 * params.rise) + unit_random3(pcg3d(key));
    let swirl = simplex_noise(place - up * (dot(place, up) * 0.4), key)
        + 0.7 * simplex_noise(place * 2.3, key + vec3u(11u));
    let lift = simplex_noise(place * 1.4 + 5.0, key + vec3u(23u));
    let share = 0.6 * params.turbulence;
    let heading = along * max(1.0 + 0.6 * share * lift, 0.2) + across * (share * swirl * length(along));
    return heading * inverseSqrt(max(dot(heading, heading), 1.0));
}

fn up_of(params: Params) -> vec3f {
    return unit_or(params.toward, vec3f(0.0, 1.0, 0.0));
}

/// Share of the smoke that stays at the surface: all on walls and below ceilings, little where the surface faces up.
/// @pass 2 @texel params.rise / 44
fn clings(at: Surface, params: Params) -> f32 {
    return 1.0 - smoothstep(0.15, 0.8, dot(at.normal, up_of(params)));
}

/// Where smoke comes from.
/// @pass 3 @texel params.rise / 44
/// @input source The mask that smoke rises from.
/// @type mask
fn entry(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return clamp(surface_here(source, at).x, 0.0, 4.0);
}

/// Smoke, and its product with the share of Rise that it has come.
/// @pass 4 @vector @texel params.rise / 44
fn start(at: Surface, entry: texture_2d_array<f32>) -> vec3f {
    return vec3f(surface_here(entry, at).x, 0.0, 0.0);
}

/// A step of all smoke, by 1.25 texels at most: taken from around the place that the velocity leads back to, with weights
/// of the same spread in every direction, however the texels are turned.
/// @pass 5 @vector @texel params.rise / 44 @repeat 1.15 * params.rise / texel / 1.25 + 4
fn smoke(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, way: texture_2d_array<f32>,
    entry: texture_2d_array<f32>, clings: texture_2d_array<f32>,
) -> vec3f {
    let metric = surface_metric(at);
    let velocity = surface_here(way, at).xyz * (1.25 * round.texel / max(metric.x * metric.z - metric.y * metric.y, 1e-30));
    let along_u = dot(velocity, at.texel_step);
    let along_v = dot(velocity, at.texel_rise);
    let moved = clamp(
        vec2f(along_u * metric.z - along_v * metric.y, along_v * metric.x - along_u * metric.y),
        vec2f(-1.45),
        vec2f(1.45),
    );
    let middle = vec2i(floor(0.5 - moved));
    let rest = vec2f(middle) + moved;
    // Three weights with the mean of the place and a chosen variance, in square texels: a quadratic B-spline has 1/4.
    let wide = rest * rest + 0.25 + 0.5 * params.spread;
    let before = 0.5 * (wide + rest);
    let behind = 0.5 * (wide - rest);
    let beside = 1.0 - wide;
    var sum = vec2f(0.0);
    for (var row = -1; row <= 1; row++) {
        let share = select(select(beside.y, behind.y, row > 0), before.y, row < 0);
        sum += share * before.x * surface_neighbor(start, at, middle + vec2i(-1, row)).xy;
        sum += share * beside.x * surface_neighbor(start, at, middle + vec2i(0, row)).xy;
        sum += share * behind.x * surface_neighbor(start, at, middle + vec2i(1, row)).xy;
    }
    let part = 1.25 * round.texel / params.rise;
    let arrives = max(sum, vec2f(0.0));
    let all = max(arrives.x, surface_here(entry, at).x);
    let age = (arrives.y + arrives.x * part) / max(all, 1e-6);
    let lost = part * (0.6 + 14.0 * (1.0 - surface_here(clings, at).x)) + 0.15 * smoothstep(0.55, 1.0, age);
    let left = all * max(1.0 - lost, 0.0);
    return vec3f(left, age * left, 0.0);
}

/// Soot: dense at the source, thinner and more broken up the further it has come.
fn mask(at: Surface, params: Params, smoke: texture_2d_array<f32>) -> f32 {
    let key = seed_key(params.seed ^ 0x2545f491u);
    let place = at.position / (0.095 * params.rise);
    let up = up_of(params);
    let drawn = place - up * (dot(place, up) * 0.45);
    let side = vec3f(simplex_noise(drawn, key), simplex_noise(drawn + 31.4, key), simplex_noise(drawn - 17.3, key));
    let way = side * (0.02 * params.rise * params.turbulence);
    let state = surface_sample(smoke, surface_walk(surface_standing(at), way)).xyz;
    let age = clamp(state.y / max(state.x, 1e-6), 0.0, 1.0);
    let billow = 0.6 * simplex_noise(drawn * 0.8, key + vec3u(5u)) + 0.4 * simplex_noise(drawn * 2.1, key + vec3u(7u));
    let broken = max(1.0 + params.turbulence * billow * (0.25 + 0.75 * age), 0.0);
    return 1.0 - exp(-2.2 * state.x * broken * (1.0 - 0.5 * age));
}
