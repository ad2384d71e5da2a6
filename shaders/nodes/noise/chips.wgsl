//! Chips
//! Flakes broken off the edges: chipped paint, stone and enamel.
//!
//! Space is divided into cells, and in each cell with an edge a flake may have broken off, with a border curved like a
//! shell and a bottom that is deepest at the edge. Flakes are on convex edges only and do not depend on the triangles of
//! the model. Use the height to sink the flakes, and the mask to show the material below.
//! @alias chipping broken edges flakes conchoidal damage wear grunge
//! @use rays cells

struct Params {
    /// Mean size of the flakes along the edge.
    /// @length @range 0.0001 100 @soft 0.01 0.3 @default 0.06
    size: f32,
    /// Largest distance from the edge that flakes reach.
    /// @length @range 0.00001 100 @soft 0.002 0.1 @default 0.02
    width: f32,
    /// Depth of the flakes at the edge.
    /// @length @range 0 100 @soft 0 0.05 @default 0.01
    depth: f32,
    /// Share of the edges that is broken off.
    /// @range 0 1 @default 0.5
    amount: f32,
    /// Stretches the flakes along the axes of the pattern.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Rays for each place; four times as many make smoother borders.
    /// @range 2 1024 @soft 8 256 @default 64
    rays: u32,
    /// Number that chooses one of many patterns of flakes.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds any @reach params.width
/// @texel max(min(params.width / 10, 2 * finest), min(params.width / 20, 4 * finest))
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.width);
}

/// The share of rays stopped inside less those stopped outside.
/// @pass 1
fn bend(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return bend_by(at, ray, hit);
}

/// 1 where a flake has broken off.
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, bend: f32, position: vec3f, params: Params) -> f32 {
    return smoothstep(0.0, 0.08, inside(bend, position, params));
}

/// Height of the broken places, below 0.
fn height(at: Surface, bend: f32, position: vec3f, params: Params) -> f32 {
    // Sinks fast at the border and lies flat toward the edge, as a shell does.
    let within = clamp(inside(bend, position, params), 0.0, 1.0);
    return -params.depth * sqrt(within * (2.0 - within));
}

/// A random value for each flake, 0 where there is none.
fn id(bend: f32, position: vec3f, params: Params) -> f32 {
    return select(0.0, unit_random(flake_of(position, params).id), inside(bend, position, params) > 0.0);
}

fn flake_of(position: vec3f, params: Params) -> NearestPoint {
    let place = cells_place(position, params.size, params.stretch, params.rotate);
    return nearest_point(place, 1.0, seed_key(params.seed), 0.0);
}

// How far inside of a flake: 0 on its border, up to about 1 at the edge.
fn inside(bend: f32, position: vec3f, params: Params) -> f32 {
    let flake = flake_of(position, params);
    let chance = unit_random(flake.id * 747796405u + 2891336453u);
    let reach = 0.35 + 0.65 * unit_random(flake.id * 277803737u + 1831565813u);
    // 1 on a right angle, and evenly less away from it.
    let near = clamp(2.0 * bend, 0.0, 1.0);
    let arc = near - (1.0 - reach) - 1.4 * flake.distance * flake.distance;
    return select(-1.0, arc / reach, chance < params.amount);
}
