//! Flow
//! Water that runs over the surface, gathers into rivulets and leaves behind what it carries: rain marks, rust runs, leaks.
//!
//! Water enters where the source is. It follows gravity over the surface, grooves and bumps of the height, and the chance
//! of its path: runs wander, split, merge and dry up. What it picked up stays where it dries, most of all along the borders
//! and at the ends of runs. Water does not cross from one separate piece of the model to the next.
//! @alias water rain run rivulet drip leak stain streak rust patina bleed seep pour weathering
//! @use surface noise

struct Params {
    /// Direction of gravity, in model space.
    /// @default 0 -1 0
    toward: vec3f,
    /// Longest distance that a run reaches. Most end earlier.
    /// @length @range 0.0001 4 @soft 0.02 1 @default 0.4
    length: f32,
    /// Width of a rivulet. Very long and narrow runs are limited to 1/100 of Length.
    /// @length @range 0.0001 1 @soft 0.004 0.05 @default 0.016
    width: f32,
    /// How much the water gathers: 0 is a film with soft borders, 1 makes thin, separate runs.
    /// @range 0 1 @default 0.6
    gather: f32,
    /// How far runs sway to the sides.
    /// @range 0 1 @default 0.4
    wander: f32,
    /// How much the surface soaks up: 0 is glass or new paint, where runs are long and leave only outlines; 1 is stone or
    /// plaster, where they are short and filled.
    /// @range 0 1 @default 0.4
    absorb: f32,
    /// How much dries up on the way: at 0, and where nothing is soaked up, all water that enters stays in the runs, as far as
    /// Length reaches.
    /// @range 0 1 @default 1
    evaporate: f32,
    /// How much water stays in drops, at the ends of runs and under overhanging edges.
    /// @range 0 1 @default 0.3
    drip: f32,
    /// Number that chooses the paths.
    /// @seed @default 0
    seed: u32,
}

/// Relief that the water follows.
/// @pass 1 @texel max(params.width / 1.6, params.length / 160)
/// @input height Relief that guides the water: runs follow its grooves and go around its bumps. @optional @default 0
fn relief(at: Surface, height: f32) -> f32 {
    return height;
}

/// Velocity of the water, at most 1.
/// @pass 2 @vector @texel max(params.width / 1.6, params.length / 160)
fn way(at: Surface, params: Params, relief: texture_2d_array<f32>) -> vec3f {
    let gravity = gravity_of(params);
    let upright = dot(gravity, at.face_normal);
    let fall = gravity - at.face_normal * upright;
    let steep = length(fall);
    let down = fall / max(steep, 1e-6);
    let across = cross(at.face_normal, down);
    let rise = surface_gradient(relief, at);
    let slope = rise * inverseSqrt(1.0 + dot(rise, rise));
    // Along the fall the water never stands still or turns back: every pit of the relief is full already. A wet bump
    // pushes the water aside the more, the more it faces up.
    let climb = dot(slope, down);
    let pushed = -1.5 * dot(slope, across) * (1.0 + max(climb, 0.0));
    // Valleys of the noise that are too fine for the texels gather nothing.
    let fine = carried(3.3 * width_of(params), at.texel_size);
    let side = pushed + fine * sway_of(at.position, across, gravity, params);
    let heading = down * max(1.0 - climb, 0.3) + across * side;
    let hanging = params.drip * smoothstep(0.1, 0.6, upright);
    let bead = bead_of(at.position, across, down, params) * hanging;
    let course = heading * inverseSqrt(max(dot(heading, heading), 1e-12));
    return (course * mix(1.0, 0.4, hanging) + bead) * smoothstep(0.02, 0.35, steep);
}

// Width of the rivulets that the level can carry, see the annotations of the passes.
fn width_of(params: Params) -> f32 {
    return max(params.width, params.length / 100.0);
}

fn gravity_of(params: Params) -> vec3f {
    let square = dot(params.toward, params.toward);
    return select(vec3f(0.0, -1.0, 0.0), params.toward * inverseSqrt(max(square, 1e-30)), square > 1e-12);
}

// Sine-like share by which the water turns aside: into the valleys of a noise drawn out along gravity, which gather it. A
// wider noise bends the valleys, so that runs sway and meet.
fn sway_of(position: vec3f, across: vec3f, gravity: vec3f, params: Params) -> f32 {
    let key = seed_key(params.seed);
    let place = position / (3.3 * width_of(params)) + unit_random3(pcg3d(key));
    let wide = place * 0.25 - gravity * (dot(place, gravity) * 0.15);
    let bend = simplex_noise(wide, key + vec3u(17u));
    let shift = across * (0.55 * params.wander * bend);
    let drawn = place + shift - gravity * (dot(place, gravity) * 0.89);
    let reach = across * 0.2;
    let pull = simplex_noise(drawn + reach, key) - simplex_noise(drawn - reach, key);
    let lean = simplex_noise(place * 0.6 - gravity * (dot(place, gravity) * 0.35), key + vec3u(29u));
    let total = 0.22 * params.wander * lean - 0.9 * params.gather * pull;
    return 0.8 * total * inverseSqrt(1.0 + total * total);
}

// Pull into drops below overhangs, in both directions.
fn bead_of(position: vec3f, across: vec3f, down: vec3f, params: Params) -> vec3f {
    let key = seed_key(params.seed ^ 0x5bd1e995u);
    let place = position / (3.5 * width_of(params));
    let pull = simplex_noise(place + across * 0.2, key) - simplex_noise(place - across * 0.2, key);
    let lift = simplex_noise(place + down * 0.2, key) - simplex_noise(place - down * 0.2, key);
    let both = (across * pull + down * lift) * 0.8;
    return both * inverseSqrt(1.0 + dot(both, both));
}

/// Water that enters, what it can pick up, and how much it brings along.
/// @pass 3 @vector @texel max(params.width / 1.6, params.length / 160)
/// @input source Where water enters and how much: a leak, an edge, or what the rain hits.
/// @input dirt What the water picks up on its way, such as rust or soot; without it, the source is what it carries.
/// @optional @default -1
fn entry(at: Surface, params: Params, source: f32, dirt: f32) -> vec3f {
    // Some places give more than others, as gaps and pores do: no two runs are equal.
    let key = seed_key(params.seed ^ 0x68e31da4u);
    let gravity = gravity_of(params);
    let place = at.position / (5.0 * width_of(params));
    let chance = simplex_noise(place - gravity * (dot(place, gravity) * 0.5), key);
    let spring = mix(1.0, clamp(0.8 * exp(0.9 * chance), 0.15, 2.0), params.gather);
    return vec3f(clamp(source, 0.0, 4.0) * spring, clamp(dirt, 0.0, 1.0), select(0.0, 1.0, dirt < 0.0));
}

/// How much the texels around ask of the water of this one, if each of them asks for what its own velocity brings.
/// @pass 4 @texel max(params.width / 1.6, params.length / 160)
fn asked(at: Surface, round: Round, way: texture_2d_array<f32>) -> f32 {
    let stride = stride_of(at, round.texel);
    var sum = 0.0;
    for (var row = -2; row <= 2; row++) {
        for (var column = -2; column <= 2; column++) {
            let step = vec2i(column, row);
            sum += weight_of(moved_by(surface_neighbor(way, at, step).xyz, stride) - vec2f(step));
        }
    }
    return max(sum, 0.15);
}

/// Water, what it carries, and the product of water and the share of Length that it has come; each divided by what is
/// asked of it.
/// @pass 5 @vector @texel max(params.width / 1.6, params.length / 160)
fn start(at: Surface, entry: texture_2d_array<f32>, asked: texture_2d_array<f32>) -> vec3f {
    let enters = surface_here(entry, at).xyz;
    return vec3f(enters.x, enters.x * enters.z, 0.0) * (0.25 / surface_here(asked, at).x);
}

/// A step of all water, by 1.25 texels at most.
///
/// Each texel takes water from around the place that its velocity leads back to, by the weights of a quadratic B-spline,
/// which spread alike in every direction, however the texels are turned. Shares are divided by all that is asked of a
/// texel, so nothing is lost or made (Lentine, Aanjaneya and Fedkiw, "Mass and Momentum Conservation for Fluid
/// Simulation", 2011). Solution, absorption and deposition after Dorsey, Pedersen and Hanrahan, "Flow and Changes in
/// Appearance", 1996, with texels in place of particles.
/// @pass 6 @vector @texel max(params.width / 1.6, params.length / 160)
/// @repeat 1.15 * params.length / texel / 1.25 + 4
fn run(
    at: Surface, round: Round, params: Params, start: texture_2d_array<f32>, way: texture_2d_array<f32>,
    asked: texture_2d_array<f32>, entry: texture_2d_array<f32>,
) -> vec3f {
    let stride = 1.25 * round.texel;
    let part = stride / params.length;
    let slow = 0.9 * params.drip;
    let moved = moved_by(surface_here(way, at).xyz, stride_of(at, round.texel));
    let middle = vec2i(round_of(-moved));
    let rest = vec2f(middle) + moved;
    let before = 0.5 * (0.5 + rest) * (0.5 + rest);
    let behind = 0.5 * (0.5 - rest) * (0.5 - rest);
    let beside = 1.0 - before - behind;
    var sum = vec3f(0.0);
    for (var row = -1; row <= 1; row++) {
        let share = select(select(beside.y, behind.y, row > 0), before.y, row < 0);
        sum += share * before.x * taken(start, at, middle + vec2i(-1, row), part, slow);
        sum += share * beside.x * taken(start, at, middle + vec2i(0, row), part, slow);
        sum += share * behind.x * taken(start, at, middle + vec2i(1, row), part, slow);
    }
    let own = surface_here(start, at).xyz;
    let asks = surface_here(asked, at).x;
    let arrived = sum + own * (asks * (1.0 - pace_of(own, slow)));
    return settled(arrived, surface_here(entry, at).xyz, part * pace_of(arrived, slow), stride, params) / asks;
}

// Nearest whole numbers.
fn round_of(place: vec2f) -> vec2f {
    return floor(place + 0.5);
}

// Water that a texel gives to its receivers.
fn taken(start: texture_2d_array<f32>, at: Surface, step: vec2i, part: f32, slow: f32) -> vec3f {
    let state = surface_neighbor(start, at, step).xyz;
    return (state + vec3f(0.0, 0.0, state.x * part)) * pace_of(state, slow);
}

// Share of the water that goes on: old water slows down into drops.
fn pace_of(state: vec3f, slow: f32) -> f32 {
    return 1.0 - slow * smoothstep(0.2, 0.5, state.z / max(state.x, 1e-6));
}

// Two vectors whose products with a velocity are its step in texels of this chart.
struct Stride {
    along_u: vec3f,
    along_v: vec3f,
}

fn stride_of(at: Surface, texel: f32) -> Stride {
    let metric = surface_metric(at);
    let scale = 1.25 * texel / max(metric.x * metric.z - metric.y * metric.y, 1e-30);
    return Stride(
        (at.texel_step * metric.z - at.texel_rise * metric.y) * scale,
        (at.texel_rise * metric.x - at.texel_step * metric.y) * scale,
    );
}

fn moved_by(velocity: vec3f, stride: Stride) -> vec2f {
    return clamp(vec2f(dot(velocity, stride.along_u), dot(velocity, stride.along_v)), vec2f(-1.45), vec2f(1.45));
}

// Weight of a quadratic B-spline in both directions.
fn weight_of(place: vec2f) -> f32 {
    let away = abs(place);
    let rest = max(1.5 - away, vec2f(0.0));
    let weight = select(0.5 * rest * rest, 0.75 - away * away, away < vec2f(0.5));
    return weight.x * weight.y;
}

// Most water of a texel, far more than covers it. Neighbors whose texels are stretched in other ways may take more from
// one than it gives; in a closed round such a gain would grow without end.
const DEEPEST: f32 = 8.0;

// What arrived, with what enters here, less what stays behind.
fn settled(arrived: vec3f, enters: vec3f, part: f32, stride: f32, params: Params) -> vec3f {
    // Fills up to the source's own value over the length of a few widths: a small leak comes to full strength, and the
    // backs between the runs of a rained-on wall stay drier than their beds.
    let share = min(stride / (1.5 * width_of(params)), 0.7);
    let fresh = share * max(enters.x - 0.8 * arrived.x, 0.0);
    let water = arrived.x + fresh;
    let age = arrived.z / max(water, 1e-6);
    let dissolved = enters.y * max(water - arrived.y, 0.0) * min(share, 0.3);
    let load = arrived.y + fresh * enters.z + dissolved;
    // A share evaporates; and each wet place soaks up the same amount, which thins out runs from their borders.
    let soaked = part * (0.15 * params.evaporate + 0.9 * params.absorb);
    let dry = smoothstep(0.5, 1.0, age);
    let rest = water * (1.0 - part * (0.5 * params.evaporate + params.absorb) - 0.12 * params.evaporate * dry) - soaked;
    let left = clamp(rest, 0.0, DEEPEST);
    let carried = min(load * (1.0 - part * (0.4 + 1.2 * params.absorb)), 3.0 * left);
    return vec3f(left, carried, age * left);
}

/// The state after the last step.
/// @pass 7 @vector @texel max(params.width / 1.6, params.length / 160)
fn water(at: Surface, run: texture_2d_array<f32>, asked: texture_2d_array<f32>) -> vec3f {
    return surface_here(run, at).xyz * surface_here(asked, at).x;
}

/// How steeply the water ends, as the share by which it changes over a quarter of a width.
/// @pass 8 @texel max(params.width / 1.6, params.length / 160)
fn border(at: Surface, params: Params, water: texture_2d_array<f32>) -> f32 {
    let rise = surface_gradient(water, at);
    return length(rise) * 0.25 * width_of(params) / (surface_here(water, at).x + 0.1);
}

/// How wet the surface is: film and runs.
fn mask(at: Surface, params: Params, water: texture_2d_array<f32>) -> f32 {
    let depth = surface_sample(water, ragged(at, params)).x;
    return 1.0 - exp(-depth * smoothstep(0.0, 0.5, depth));
}

/// What the water has left behind: where the surface soaked it up, along borders, and at the ends of runs.
fn deposit(at: Surface, params: Params, water: texture_2d_array<f32>, border: texture_2d_array<f32>) -> f32 {
    let walk = ragged(at, params);
    let state = surface_sample(water, walk).xyz;
    let rim = smoothstep(0.1, 0.55, surface_sample(border, walk).x) * smoothstep(0.0, 0.12, state.x);
    // Water that has nearly gone has left nearly all of its load.
    let dense = clamp(0.5 * state.y / max(state.x, 1e-4), 0.0, 1.0);
    let body = (1.0 - exp(-0.9 * state.y)) * mix(0.3, 0.95, params.absorb);
    // Deep water washes its own border clean again.
    let edge = rim * mix(0.4, 0.9, dense) * (1.0 - exp(-5.0 * state.y)) / (1.0 + 0.4 * state.x);
    return clamp(body + (1.0 - body) * edge, 0.0, 1.0);
}

/// Direction in which the water runs, as long as its speed: 0 on level ground, at most 1.
/// @vector
fn direction(at: Surface, way: texture_2d_array<f32>) -> vec3f {
    return surface_here(way, at).xyz;
}

// A place a little aside, by a fine noise: borders are as ragged as the surface is rough.
fn ragged(at: Surface, params: Params) -> Walk {
    let key = seed_key(params.seed ^ 0x2545f491u);
    let place = at.position / (3.0 * width_of(params));
    let side = vec3f(simplex_noise(place, key), simplex_noise(place + 31.4, key), simplex_noise(place - 17.3, key));
    return surface_walk(surface_standing(at), side * (0.1 * width_of(params) * (0.3 + params.absorb)));
}
