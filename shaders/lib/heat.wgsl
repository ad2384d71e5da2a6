//! Blur as heat that flows over the surface: the Gaussian of standard deviation `radius` is reached after the time
//! `radius² / 2`.
//!
//! The flow between two texels follows from how they lie on the surface (the Laplace-Beltrami operator; mixed terms over the
//! diagonals, limited so that no weight is negative). On points it follows from the cells around them. As many stages as five
//! times the texels of the radius, not their square, give heat to a thousandth. Written as sums of differences, so that an even
//! mask stays as it is to the last bit.
//! @use core surface

/// Least variance of the random walk whose steps the stages are, half the time for texels of width 1 times the fastest decay:
/// the number of stages is 3.6 times its root, as the annotations that count them know.
const HEAT_LEAST_SPREAD: f32 = 8.0;

/// Area of a texel by how it lies on the surface, see `surface_metric`.
fn heat_area(metric: vec3f) -> f32 {
    return sqrt(max(metric.x * metric.z - metric.y * metric.y, 1e-30));
}

/// Flow of heat through a texel: weights along u, along v, and along a diagonal, below 0 along the falling one.
fn heat_conduction(metric: vec3f) -> vec3f {
    let area = heat_area(metric);
    let along = clamp(vec2f(metric.z, metric.x) / area, vec2f(1e-3), vec2f(1e3));
    let most = min(along.x, along.y);
    let across = clamp(-metric.y / area, -most, most);
    return vec3f(along - abs(across), across);
}

/// Rates of the flow between a texel and its neighbors in a unit of time, for texels as wide as `round.texel`.
struct HeatRates {
    east: f32,
    west: f32,
    south: f32,
    north: f32,
    /// Along the diagonal that is shorter on the surface, below 0 along the falling one; 0 on charts that are not sheared.
    diagonal: f32,
}

/// The rates of a texel. The weight between two texels is the mean of both, so that one gains as much as the other loses.
fn heat_rates(at: Surface, round: Round) -> HeatRates {
    let metric = surface_metric(at);
    let own = heat_conduction(metric);
    let east = 0.5 * (own.x + heat_conduction(surface_metric_near(at, vec2i(1, 0))).x);
    let west = 0.5 * (own.x + heat_conduction(surface_metric_near(at, vec2i(-1, 0))).x);
    let south = 0.5 * (own.y + heat_conduction(surface_metric_near(at, vec2i(0, 1))).y);
    let north = 0.5 * (own.y + heat_conduction(surface_metric_near(at, vec2i(0, -1))).y);
    let area = heat_area(metric) / (round.texel * round.texel);
    // Texels much finer than the others are slowed down: otherwise the time step would be too long for them.
    let total = east + west + south + north + 2.0 * abs(own.z);
    let slowed = 1.0 / max(area, 0.25 * total);
    return HeatRates(east * slowed, west * slowed, south * slowed, north * slowed, own.z * slowed);
}

/// Flow along u, and along the diagonal: rates to the east and to the west, and that of the diagonal. Plain texture
/// space is a flat surface of equal texels. On points the rates are those of `surface_flow`.
fn heat_across(at: Surface, round: Round, on_texture: bool) -> vec3f {
    let rates = heat_rates(at, round);
    return select(vec3f(rates.east, rates.west, rates.diagonal), vec3f(1.0, 1.0, 0.0), on_texture);
}

/// Flow along v: rates to the south and to the north.
fn heat_along(at: Surface, round: Round, on_texture: bool) -> vec3f {
    let rates = heat_rates(at, round);
    return select(vec3f(rates.south, rates.north, 0.0), vec3f(1.0, 1.0, 0.0), on_texture);
}

/// Heat that flows to a texel in a unit of time. Written out: software adapters are slow at short loops.
fn heat_flow(
    state: texture_2d_array<f32>,
    across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
    at: Surface,
) -> f32 {
    if surface_is_scattered() {
        return surface_flow(state, at);
    }
    let along_u = surface_here(across, at).xyz;
    let along_v = surface_here(along, at).xy;
    let center = surface_here(state, at).x;
    let straight = along_u.x * (surface_neighbor(state, at, vec2i(1, 0)).x - center)
        + along_u.y * (surface_neighbor(state, at, vec2i(-1, 0)).x - center)
        + along_v.x * (surface_neighbor(state, at, vec2i(0, 1)).x - center)
        + along_v.y * (surface_neighbor(state, at, vec2i(0, -1)).x - center);
    let rise = select(-1, 1, along_u.z > 0.0);
    return straight + abs(along_u.z) * (surface_neighbor(state, at, vec2i(1, rise)).x - center
        + surface_neighbor(state, at, vec2i(-1, -rise)).x - center);
}

/// Start of a blur: the polynomial of degree 0, the one before it, and the sum so far.
fn heat_start(value: f32) -> vec3f {
    return vec3f(value);
}

/// A single stage; `state` holds the result of `heat_start` or of the stage before. There are `round.count` of them. The last one
/// gives the value, and 1 in the third component.
///
/// Heat after a time is a series of Chebyshev polynomials of the flow, whose coefficients are Bessel functions (Tal-Ezer 1989).
/// They are all positive, so the sum is kept as a mean, of which each polynomial takes its share.
fn heat_stage(
    state: texture_2d_array<f32>,
    across: texture_2d_array<f32>,
    along: texture_2d_array<f32>,
    at: Surface,
    round: Round,
    radius: f32,
) -> vec3f {
    let before = surface_here(state, at).xyz;
    let time = heat_time(round, radius);
    let spread = max(4.0 * time, HEAT_LEAST_SPREAD);
    let step = time / spread * heat_flow(state, across, along, at);
    let later = before.x + (before.x - before.y) + select(2.0, 1.0, round.index == 0u) * step;
    let degree = f32(round.index + 1u);
    let within = heat_share_within(degree, spread);
    let share = 1.0 - heat_share_within(degree - 1.0, spread) / within;
    let mean = before.z + share * (later - before.z);
    if round.index + 1u < round.count {
        return vec3f(later, before.x, mean);
    }
    return vec3f(mean, mean, 1.0);
}

/// Share of the sum that polynomials up to a degree have: how often a random walk with this variance ends within so many steps
/// of its start. The normal distribution, corrected for steps (Sheppard) and for its fourth cumulant (Edgeworth): right to a
/// thousandth from a variance of eight on.
fn heat_share_within(degree: f32, spread: f32) -> f32 {
    let x = (degree + 0.5) / sqrt(spread - 1.0 / 12.0);
    let density = exp(-0.5 * x * x) * 0.3989423;
    return heat_error_function(x * 0.7071068) - density * (x * x * x - 3.0 * x) / (12.0 * spread);
}

/// The error function of a positive number (Abramowitz, Stegun 7.1.26).
fn heat_error_function(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.3275911 * x);
    let series = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return 1.0 - series * exp(-x * x);
}

/// Time that heat flows, in squares of `round.texel`, less the blur of the way to the coarser level and back and that of
/// `heat_finish`. Both ways to coarser texels blur like a Gaussian of half a coarser texel's width; the mean over the cell of a
/// point like one of three eighths of the spacing.
fn heat_time(round: Round, radius: f32) -> f32 {
    let coarser = select(0.0, 0.25, round.texel > 1.5 * round.finest);
    let moved = select(coarser, 0.14, surface_is_scattered()) * round.texel * round.texel;
    let finish = heat_finish_share(round, radius) * round.finest * round.finest;
    return 0.5 * max(radius * radius - moved - finish, 0.0) / (round.texel * round.texel);
}

/// How much of its full strength the finish has; none for radii below its own.
fn heat_finish_share(round: Round, radius: f32) -> f32 {
    return clamp(radius * radius / (round.finest * round.finest), 0.0, 1.0);
}

/// Stands for a value of 0 on a coarser level: where that has nothing near, a place of the finest level gets 0.
const HEAT_ZERO: f32 = 1e-30;

/// The value after the last stage, which is never 0.
fn heat_settled(heat: texture_2d_array<f32>, at: Surface) -> f32 {
    let value = surface_here(heat, at).x;
    return select(value, HEAT_ZERO, value == 0.0);
}

/// A settled value without what stands for 0.
fn heat_value(settled: f32) -> f32 {
    return select(settled, 0.0, abs(settled) < 2.0 * HEAT_ZERO);
}

/// The settled value of a place; its `own` one where the coarser level has nothing near, which is a speck smaller than the radius.
fn heat_or(settled: texture_2d_array<f32>, at: Surface, own: f32) -> f32 {
    let value = surface_here(settled, at).x;
    return select(heat_value(value), own, value == 0.0);
}

/// Half of the finish, which smooths the corners that interpolation from a coarser level leaves: weights 1 2 1 both ways
/// around `center`, at full strength a variance of half a texel of the finest. `state` holds settled values, or those of the first half.
fn heat_finish(state: texture_2d_array<f32>, at: Surface, round: Round, radius: f32, center: f32) -> f32 {
    let area = heat_area(surface_metric(at));
    let share = heat_finish_share(round, radius) * min(round.finest * round.finest / area, 1.0);
    let beside = (heat_value(surface_neighbor(state, at, vec2i(1, 0)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(-1, 0)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(0, 1)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(0, -1)).x) - center);
    let across = (heat_value(surface_neighbor(state, at, vec2i(1, 1)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(-1, 1)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(1, -1)).x) - center)
        + (heat_value(surface_neighbor(state, at, vec2i(-1, -1)).x) - center);
    return center + share * (0.125 * beside + 0.0625 * across);
}
