//! React
//! Spots, worms, mazes, holes, coral and rings that grow over the surface by themselves: skin, lichen, corrosion, coral.
//!
//! Two substances spread over the surface, one feeds on the other, and patterns form. It starts from patches scattered over
//! the surface, or over a mask, and grows from there with each step. Small sizes on large models take long.
//! @alias reaction diffusion gray scott turing lichen corrosion brain leopard skin zebra labyrinth patina rust growth
//! @use surface heat cells

struct Params {
    /// Distance between neighboring spots or stripes.
    /// @length @range 0.001 4 @soft 0.01 0.3 @default 0.1
    size: f32,
    /// The kind of pattern. Spots divide until they fill the surface, worms and coral branch, a maze closes up, holes are its
    /// opposite, and rings run outward and vanish.
    /// @choice spots worms maze holes coral rings @default coral
    pattern: u32,
    /// How long it grows: patterns cover the surface from about 1000 to 3000 on; rings are best at 200 to 600.
    /// @range 1 4096 @soft 100 4000 @default 800
    steps: u32,
    /// Share of the surface that it starts from, where no mask is connected.
    /// @range 0 1 @default 0.6
    start: f32,
    /// How soft the borders of the pattern are: 0 is a sharp line, 1 the slow change of the substance itself.
    /// @range 0 1 @default 0.4
    softness: f32,
    /// Number that chooses where it starts.
    /// @seed @default 0
    seed: u32,
}

/// How substances flow from texel to texel: weights along u, along v and along a diagonal, for texels as wide as a round's.
/// @pass 1 @texel params.size / 17
fn conduction(at: Surface, round: Round) -> vec3f {
    let metric = surface_metric(at);
    let weights = heat_conduction(metric);
    let area = heat_area(metric) / (round.texel * round.texel);
    // Texels much finer than the others are slowed down: otherwise the step would be too long for them.
    let total = 2.0 * (weights.x + weights.y + abs(weights.z));
    return weights / max(area, 0.25 * total);
}

/// Where it starts and where it may grow.
/// @pass 2 @vector
/// @input source Where it starts: the higher, the more of the places that Start takes at random. @optional @default 1
/// @input area Where it can live: above 0.5 it grows, below 0.25 it dies off. @optional @default 1
fn given(source: f32, area: f32) -> vec3f {
    return vec3f(clamp(source, 0.0, 1.0), clamp(area, 0.0, 1.0), 0.0);
}

/// Both substances before the first step, and where the second one can live.
/// @pass 3 @vector @texel params.size / 8.5
fn before(at: Surface, params: Params, given: texture_2d_array<f32>) -> vec3f {
    let known = surface_here(given, at).xyz;
    let key = seed_key(params.seed);
    // Patches without any order, since round spots would all become rings.
    let place = wrapped(at.position / (0.5 * params.size));
    let patch_share = normal_share(simplex_noise(place, key));
    // What is fed slowly starves where it starts on too much of the surface.
    let most = select(0.5, 0.2, params.pattern == 0u || params.pattern == 2u);
    let covered = smoothstep(0.0, 0.1, patch_share - 1.0 + most * params.start * known.x);
    // Rings want round spots, and room to run.
    let nearest = nearest_point(cells_place(at.position, 2.5 * params.size, vec3f(1.0), vec3f(0.0)), 1.0, key, 0.0);
    let spot = 1.0 - smoothstep(0.18, 0.24, nearest.distance);
    let is_taken = unit_random(nearest.id) < params.start * known.x;
    let seeded = known.y * select(covered, select(0.0, spot, is_taken), params.pattern == 5u);
    let second = 0.45 * seeded;
    return vec3f(1.0 - 0.5 * seeded, second, known.y);
}

/// Steps of time on a coarse level, for three quarters of the way.
/// @pass 4 @vector @texel params.size / 8.5
/// @repeat ceil(0.75 * params.steps * max(0.5, params.size * params.size / (542 * texel * texel)))
fn grow(at: Surface, round: Round, params: Params, before: texture_2d_array<f32>, conduction: texture_2d_array<f32>) -> vec3f {
    return stepped(before, conduction, at, round, params);
}

/// What has grown, on a level that shows it round: texels as coarse as those before hold borders fast along their own axes.
/// @pass 5 @vector @texel params.size / 17
fn grown(at: Surface, grow: texture_2d_array<f32>) -> vec3f {
    return surface_here(grow, at).xyz;
}

/// The last steps.
/// @pass 6 @vector @texel params.size / 17
/// @repeat ceil(0.25 * params.steps * max(0.5, params.size * params.size / (542 * texel * texel)))
fn react(at: Surface, round: Round, params: Params, grown: texture_2d_array<f32>, conduction: texture_2d_array<f32>) -> vec3f {
    return stepped(grown, conduction, at, round, params);
}

/// The second substance on a finer level.
/// @pass 7 @texel params.size / 40
fn amount(at: Surface, react: texture_2d_array<f32>) -> f32 {
    return surface_here(react, at).y;
}

/// The same without the corners that interpolation leaves.
/// @pass 8 @texel params.size / 40 @repeat 4
fn smooth_amount(at: Surface, amount: texture_2d_array<f32>) -> f32 {
    let straight = surface_neighbor(amount, at, vec2i(1, 0)).x + surface_neighbor(amount, at, vec2i(-1, 0)).x
        + surface_neighbor(amount, at, vec2i(0, 1)).x + surface_neighbor(amount, at, vec2i(0, -1)).x;
    let across = surface_neighbor(amount, at, vec2i(1, 1)).x + surface_neighbor(amount, at, vec2i(-1, 1)).x
        + surface_neighbor(amount, at, vec2i(1, -1)).x + surface_neighbor(amount, at, vec2i(-1, -1)).x;
    return 0.25 * surface_here(amount, at).x + 0.125 * straight + 0.0625 * across;
}

/// The pattern: 1 where the second substance is.
fn mask(at: Surface, params: Params, smooth_amount: texture_2d_array<f32>) -> f32 {
    let amount = amount_at(at, params, smooth_amount);
    let half = max(0.5 * params.softness, 0.02);
    return mix(0.45, smoothstep(0.5 - half, 0.5 + half, amount), carried(params.size, at.texel_size));
}

/// A rounded profile: 0 between, 1 along the middle of the pattern.
fn height(at: Surface, params: Params, smooth_amount: texture_2d_array<f32>) -> f32 {
    let t = clamp(amount_at(at, params, smooth_amount), 0.0, 1.0);
    return mix(0.45, t * t * (3.0 - 2.0 * t), carried(params.size, at.texel_size));
}

// The second substance, as a share of what it is in the middle of the pattern.
fn amount_at(at: Surface, params: Params, smooth_amount: texture_2d_array<f32>) -> f32 {
    return surface_here(smooth_amount, at).x / rates_of(params.pattern).z;
}

// Distance of features for a diffusion of 1, measured; the repetitions of `react` know it, too: 0.28 of its square.
const FEATURE: f32 = 44.0;

// Rates of feeding and of decay for a pattern, from the maps of Pearson (1993) and Munafo (2014), and the amount in its
// middle, measured.
fn rates_of(pattern: u32) -> vec3f {
    switch pattern {
        case 0u: { return vec3f(0.03, 0.0615, 0.34); }
        case 1u: { return vec3f(0.054, 0.063, 0.36); }
        case 2u: { return vec3f(0.029, 0.057, 0.34); }
        case 3u: { return vec3f(0.039, 0.058, 0.34); }
        case 4u: { return vec3f(0.0545, 0.062, 0.36); }
        default: { return vec3f(0.012, 0.044, 0.30); }
    }
}

// Both substances one step of time later.
fn stepped(
    state: texture_2d_array<f32>, conduction: texture_2d_array<f32>, at: Surface, round: Round, params: Params,
) -> vec3f {
    let own = surface_here(state, at).xyz;
    let rates = rates_of(params.pattern);
    // Distances in the pattern grow with the root of the diffusion. Slower than this, texels would hold the pattern fast.
    let length = params.size / (FEATURE * round.texel);
    let diffusion = max(length * length, 0.035);
    // As long as nothing swings: a quarter of a texel's square for the diffusion, and two units for the reaction.
    let time = min(2.0, 0.28 / diffusion);
    // The same for single wide texels, where a model stretches its UVs unevenly: there the pattern is larger.
    let weights = surface_here(conduction, at).xyz;
    let least = 0.035 / max(diffusion * min(weights.x, weights.y), 1e-9);
    let most = 0.28 / max(diffusion * time * max(weights.x, weights.y), 1e-9);
    let flow = diffusion * max(min(least, most), 1.0) * spread(state, weights, at);
    let met = own.x * own.y * own.y;
    let kill = rates.y + 0.03 * (1.0 - smoothstep(0.25, 0.5, own.z));
    // Gray and Scott's reaction (Pearson, "Complex patterns in a simple system", 1993).
    let first = own.x + time * (flow.x - met + rates.x * (1.0 - own.x));
    let second = own.y + time * (0.5 * flow.y + met - (rates.x + kill) * own.y);
    return vec3f(clamp(first, 0.0, 1.0), clamp(second, 0.0, 1.0), own.z);
}

// What flows to a texel of both substances in a step at a diffusion of 1. The nine texels of Mehrstellen (Collatz 1960) spread
// alike in all directions and allow longer steps than five.
fn spread(state: texture_2d_array<f32>, weights: vec3f, at: Surface) -> vec2f {
    let center = surface_here(state, at).xy;
    let beside = surface_neighbor(state, at, vec2i(1, 0)).xy + surface_neighbor(state, at, vec2i(-1, 0)).xy - 2.0 * center;
    let along = surface_neighbor(state, at, vec2i(0, 1)).xy + surface_neighbor(state, at, vec2i(0, -1)).xy - 2.0 * center;
    let rising = surface_neighbor(state, at, vec2i(1, 1)).xy + surface_neighbor(state, at, vec2i(-1, -1)).xy - 2.0 * center;
    let falling = surface_neighbor(state, at, vec2i(1, -1)).xy + surface_neighbor(state, at, vec2i(-1, 1)).xy - 2.0 * center;
    let even = min(weights.x, weights.y) / 6.0;
    return weights.x * beside + weights.y * along + max(weights.z, 0.0) * rising + max(-weights.z, 0.0) * falling
        + even * (rising + falling - 2.0 * (beside + along));
}
