//! Blur as heat that flows over the surface: the Gaussian of standard deviation `radius` is reached after the time
//! `radius² / 2`.
//!
//! The flow between two texels follows from how they lie on the surface (the Laplace-Beltrami operator; mixed terms over the
//! diagonals, limited so that no weight is negative: nothing gets hotter than the hottest). Time steps are
//! Runge-Kutta-Legendre's of first order (Meyer, Balsara, Aslam 2012), in four cycles: as many stages as the radius has
//! texels, not their square. Written as sums of differences, so that an even mask stays as it is to the last bit.
//! @use core surface

/// Cycles of stages; the annotation that counts the stages knows it, too.
const HEAT_CYCLES: u32 = 4u;

/// How heat flows through a texel: weights along u, along v, and along a diagonal, below 0 along the falling one. Plain
/// texture space is a flat surface of equal texels.
fn heat_conduction(at: Surface, on_texture: bool) -> vec3f {
    let metric = surface_metric(at);
    let area = sqrt(max(metric.x * metric.z - metric.y * metric.y, 1e-30));
    let along = clamp(vec2f(metric.z, metric.x) / area, vec2f(1e-3), vec2f(1e3));
    let most = min(along.x, along.y);
    let across = clamp(-metric.y / area, -most, most);
    return select(vec3f(along - abs(across), across), vec3f(1.0, 1.0, 0.0), on_texture);
}

/// Heat that flows to a texel in a unit of time, for texels as wide as `round.texel`.
///
/// The weight between two texels is the mean of both, so that one gains as much as the other loses. Written out: software
/// adapters are slow at short loops.
fn heat_flow(
    state: texture_2d_array<f32>,
    conduction: texture_2d_array<f32>,
    at: Surface,
    round: Round,
    on_texture: bool,
) -> f32 {
    let own = surface_here(conduction, at).xyz;
    let center = surface_here(state, at).x;
    let east = 0.5 * (own.x + surface_neighbor(conduction, at, vec2i(1, 0)).x);
    let west = 0.5 * (own.x + surface_neighbor(conduction, at, vec2i(-1, 0)).x);
    let south = 0.5 * (own.y + surface_neighbor(conduction, at, vec2i(0, 1)).y);
    let north = 0.5 * (own.y + surface_neighbor(conduction, at, vec2i(0, -1)).y);
    let flow = east * (surface_neighbor(state, at, vec2i(1, 0)).x - center)
        + west * (surface_neighbor(state, at, vec2i(-1, 0)).x - center)
        + south * (surface_neighbor(state, at, vec2i(0, 1)).x - center)
        + north * (surface_neighbor(state, at, vec2i(0, -1)).x - center);
    // Sheared charts only: the diagonal that is shorter on the surface.
    let rise = select(-1, 1, own.z > 0.0);
    let across = abs(own.z) * (surface_neighbor(state, at, vec2i(1, rise)).x - center
        + surface_neighbor(state, at, vec2i(-1, -rise)).x - center);
    let metric = surface_metric(at);
    let area = sqrt(max(metric.x * metric.z - metric.y * metric.y, 1e-30)) / (round.texel * round.texel);
    // Texels much finer than the others are slowed down: otherwise the time step would be too long for them.
    let total = east + west + south + north + 2.0 * abs(own.z);
    return (flow + across) / max(select(area, 1.0, on_texture), 0.25 * total);
}

/// Start of a blur: value, value of the stage before, and 1.
fn heat_start(value: f32) -> vec3f {
    return vec3f(value, value, 1.0);
}

/// One stage; `state` holds the result of `heat_start` or of the stage before. There are `round.count` of them.
fn heat_stage(
    state: texture_2d_array<f32>,
    conduction: texture_2d_array<f32>,
    at: Surface,
    round: Round,
    radius: f32,
    on_texture: bool,
) -> vec3f {
    let before = surface_here(state, at).xyz;
    let stages = max(round.count / HEAT_CYCLES, 1u);
    let j = f32(round.index % stages + 1u);
    let s = f32(stages);
    let time = heat_time(round, radius) / f32(HEAT_CYCLES);
    let step = time * 2.0 / (s * s + s) * heat_flow(state, conduction, at, round, on_texture);
    let later = before.x + (1.0 - 1.0 / j) * (before.x - before.y) + (2.0 * j - 1.0) / j * step;
    return vec3f(later, before.x, 1.0);
}

/// Time that heat flows, in squares of `round.texel`, less the blur of the way to the coarser level and back and that of
/// `heat_finish`. Both ways together blur like a Gaussian of half a coarser texel's width.
fn heat_time(round: Round, radius: f32) -> f32 {
    let moved = select(0.0, 0.25 * round.texel * round.texel, round.texel > 1.5 * round.finest);
    let finish = heat_finish_share(round, radius) * round.finest * round.finest;
    return 0.5 * max(radius * radius - moved - finish, 0.0) / (round.texel * round.texel);
}

/// How much of its full strength the finish has; none for radii below its own.
fn heat_finish_share(round: Round, radius: f32) -> f32 {
    return clamp(radius * radius / (round.finest * round.finest), 0.0, 1.0);
}

/// Half of the finish, which smooths the corners that interpolation from a coarser level leaves: weights 1 2 1 both ways
/// around `center`, at full strength a variance of half a texel of the finest.
fn heat_finish(state: texture_2d_array<f32>, at: Surface, round: Round, radius: f32, center: f32) -> f32 {
    let metric = surface_metric(at);
    let area = sqrt(max(metric.x * metric.z - metric.y * metric.y, 1e-30));
    let share = heat_finish_share(round, radius) * min(round.finest * round.finest / area, 1.0);
    let beside = (surface_neighbor(state, at, vec2i(1, 0)).x - center)
        + (surface_neighbor(state, at, vec2i(-1, 0)).x - center)
        + (surface_neighbor(state, at, vec2i(0, 1)).x - center)
        + (surface_neighbor(state, at, vec2i(0, -1)).x - center);
    let across = (surface_neighbor(state, at, vec2i(1, 1)).x - center)
        + (surface_neighbor(state, at, vec2i(-1, 1)).x - center)
        + (surface_neighbor(state, at, vec2i(1, -1)).x - center)
        + (surface_neighbor(state, at, vec2i(-1, -1)).x - center);
    return center + share * (0.125 * beside + 0.0625 * across);
}
