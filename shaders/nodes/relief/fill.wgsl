//! Fill
//! What settles in the relief and on the model: dust, sand, snow, puddles, wax.
//!
//! An even amount falls on all that faces up, runs or slides downhill until it lies still, fills the grooves first and covers
//! the rest after that. Powder stays on slopes up to its angle and piles up below steeper ones; Puddle lies level; Film
//! clings to all sides and only evens out the relief. Height is the thickness of the new layer: add it to the height below.
//! @alias snow dust sand puddle water settle accumulate cover powder dirt fill wet pool deposit
//! @use surface

struct Params {
    /// What settles: powder keeps an angle, a puddle lies level, a film clings to all sides.
    /// @choice powder puddle film @default powder
    mode: u32,
    /// Thickness of the layer if it were even.
    /// @length @range 0 10 @soft 0 0.05 @default 0.006
    amount: f32,
    /// Steepest angle at which powder lies still.
    /// @angle @range 0 85 @default 38
    stiff: f32,
    /// How much edges of the layer are rounded. Those of powder crumble down its slopes; those of puddles and films run out
    /// evenly, on parts that are thinner than this share of Amount.
    /// @range 0 1 @default 0.3
    smooth_edges: f32,
    /// Largest distance that it moves on the surface, and width of the surroundings in which grooves fill up together.
    /// @length @range 0.0001 2 @soft 0.01 0.3 @default 0.08
    reach: f32,
    /// Direction in which it falls, in model space.
    /// @range -1 1 @default 0 -1 0
    toward: vec3f,
}

const POWDER: u32 = 0u;
const FILM: u32 = 2u;

/// Share of what lies at a place that goes to one neighbor at most: four of them take no more than there is.
const MOST: f32 = 0.24;

// How much a place faces up; all sides of a film do.
fn upward(at: Surface, params: Params) -> f32 {
    let up = -params.toward * inverseSqrt(max(dot(params.toward, params.toward), 1e-12));
    return select(dot(at.normal, up), 1.0, params.mode == FILM);
}

// Share that stays on a slope which faces up so much: all below the angle of rest, nothing well above it.
fn held_share(facing: f32, params: Params) -> f32 {
    let flat_ends = select(radians(4.0), params.stiff, params.mode == POWDER);
    let steep_begins = flat_ends + radians(14.0);
    let held = smoothstep(cos(steep_begins), cos(flat_ends), facing);
    return select(held, 1.0, params.mode == FILM);
}

/// The relief, and what falls on it.
/// @pass 1 @vector
/// @input height The height that the graph creates, in working units. @optional @default 0
/// @input source How much falls. @optional @default 1
fn fallen(at: Surface, params: Params, height: f32, source: f32) -> vec3f {
    let facing = upward(at, params);
    // Most of what falls on a steep slope jumps off it; the rest slides.
    let stays = mix(0.35, 1.0, held_share(facing, params));
    let falls = params.amount * max(source, 0.0) * max(facing, 0.0) * stays;
    return vec3f(height, falls, 0.0);
}

/// Thickness of the layer, elevation of the ground, how much it faces up.
/// @pass 2 @vector @texel min(params.reach / 12, 8 * finest)
fn start(at: Surface, params: Params, fallen: texture_2d_array<f32>) -> vec3f {
    let state = surface_here(fallen, at);
    let up = -params.toward * inverseSqrt(max(dot(params.toward, params.toward), 1e-12));
    let facing = upward(at, params);
    let place = select(dot(at.position, up), 0.0, params.mode == FILM);
    return vec3f(state.y, place + state.x * facing, facing);
}

// What a neighbor gives to this place, below 0 what it takes.
fn given(own: vec3f, other: vec3f, width: f32, params: Params) -> f32 {
    let drop = other.y + other.x * max(other.z, 0.15) - own.y - own.x * max(own.z, 0.15);
    let held = select(0.0, tan(params.stiff) * width, params.mode == POWDER);
    let slide = 0.2 * max(abs(drop) - held, 0.0);
    // What is smoothed creeps, whatever the angle.
    let creep = 0.1 * params.smooth_edges * min(abs(drop), held);
    let moved = slide + creep;
    return select(-min(moved, MOST * own.x), min(moved, MOST * other.x), drop > 0.0);
}

/// The layer after it has run, slid and settled: material goes to lower neighbors where the slope between them is steeper than
/// it holds (Hsu and Wong, "Simulating Dust Accumulation", 1995; Fearing, "Computer Modelling of Fallen Snow", 2000).
/// @pass 3 @vector @texel min(params.reach / 12, 8 * finest)
/// @repeat min(ceil(4 * params.reach / texel), 126) + 2
fn settled(at: Surface, params: Params, start: texture_2d_array<f32>) -> vec3f {
    let own = surface_here(start, at).xyz;
    let metric = surface_metric(at);
    let wide = sqrt(metric.x);
    let high = sqrt(metric.z);
    let gain = given(own, surface_neighbor(start, at, vec2i(1, 0)).xyz, wide, params)
        + given(own, surface_neighbor(start, at, vec2i(-1, 0)).xyz, wide, params)
        + given(own, surface_neighbor(start, at, vec2i(0, 1)).xyz, high, params)
        + given(own, surface_neighbor(start, at, vec2i(0, -1)).xyz, high, params);
    // It falls off what hangs over.
    return vec3f(select(0.0, max(own.x + gain, 0.0), own.z > 0.0), own.yz);
}

/// The surface of the layer, its thickness, and a correction.
/// @pass 4 @vector @texel min(params.reach / 12, 8 * finest)
fn surface(at: Surface, params: Params, fallen: texture_2d_array<f32>, settled: texture_2d_array<f32>) -> vec3f {
    let thick = surface_here(settled, at).x;
    let kept = thick * held_share(surface_here(settled, at).z, params);
    return vec3f(surface_here(fallen, at).x + kept, kept, 0.0);
}

// What lies between the fine relief and the surface of the layer, and whether anything does.
fn between(at: Surface, fallen: texture_2d_array<f32>, surface: texture_2d_array<f32>) -> vec3f {
    let state = surface_here(surface, at);
    let thick = max(state.x + state.z - surface_here(fallen, at).x, 0.0);
    return vec3f(thick, select(0.0, 1.0, thick > 0.0), 0.0);
}

// The surface, lowered until the grooves below it hold as much as there is: a step of Newton's method, which comes from
// above and never goes too far, since more is covered the higher the surface is.
fn lowered(at: Surface, surface: texture_2d_array<f32>, laid: texture_2d_array<f32>) -> vec3f {
    let state = surface_here(surface, at).xyz;
    let held = surface_here(laid, at);
    return vec3f(state.xy, state.z + min(state.y - held.x, 0.0) / max(held.y, 0.05));
}

/// The layer on the fine relief.
/// @pass 5 @vector
fn laid(at: Surface, fallen: texture_2d_array<f32>, surface: texture_2d_array<f32>) -> vec3f {
    return between(at, fallen, surface);
}

/// The surface, lowered.
/// @pass 6 @vector @texel min(params.reach / 12, 8 * finest)
fn second(at: Surface, surface: texture_2d_array<f32>, laid: texture_2d_array<f32>) -> vec3f {
    return lowered(at, surface, laid);
}

/// The layer below it.
/// @pass 7 @vector
fn laid_second(at: Surface, fallen: texture_2d_array<f32>, second: texture_2d_array<f32>) -> vec3f {
    return between(at, fallen, second);
}

/// The surface, lowered once more.
/// @pass 8 @vector @texel min(params.reach / 12, 8 * finest)
fn third(at: Surface, second: texture_2d_array<f32>, laid_second: texture_2d_array<f32>) -> vec3f {
    return lowered(at, second, laid_second);
}

/// The layer below that.
/// @pass 9 @vector
fn laid_third(at: Surface, fallen: texture_2d_array<f32>, third: texture_2d_array<f32>) -> vec3f {
    return between(at, fallen, third);
}

/// The surface in the end.
/// @pass 10 @vector @texel min(params.reach / 12, 8 * finest)
fn last(at: Surface, third: texture_2d_array<f32>, laid_third: texture_2d_array<f32>) -> vec3f {
    return lowered(at, third, laid_third);
}

fn thickness(at: Surface, params: Params, fallen: texture_2d_array<f32>, last: texture_2d_array<f32>) -> f32 {
    // Nothing is left in grooves where nothing came to rest.
    let any = smoothstep(0.0, 0.03, surface_here(last, at).y / max(params.amount, 1e-9));
    let thick = between(at, fallen, last).x * any;
    let thin = select(params.smooth_edges * params.amount, 0.0, params.mode == POWDER);
    return thick * select(1.0, smoothstep(0.0, thin, thick), thin > 0.0);
}

/// Where the layer lies; thin parts are translucent.
fn mask(at: Surface, params: Params, fallen: texture_2d_array<f32>, last: texture_2d_array<f32>) -> f32 {
    return smoothstep(0.0, 0.2 * max(params.amount, 1e-9), thickness(at, params, fallen, last));
}

/// Thickness of the layer over the relief, to be added to the height below.
fn height(at: Surface, params: Params, fallen: texture_2d_array<f32>, last: texture_2d_array<f32>) -> f32 {
    return thickness(at, params, fallen, last);
}

/// Thickness of the layer as a share: 1 is twice the even thickness.
fn depth(at: Surface, params: Params, fallen: texture_2d_array<f32>, last: texture_2d_array<f32>) -> f32 {
    return clamp(0.5 * thickness(at, params, fallen, last) / max(params.amount, 1e-9), 0.0, 1.0);
}
