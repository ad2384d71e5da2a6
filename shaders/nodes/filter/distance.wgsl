//! Distance
//! A mask that fades with the distance from another mask, over the surface and around corners.
//!
//! The distance is that of the shortest path over the surface, not through the air: it does not jump from one leg of a chair
//! to the next. Direction and Id follow that path back to its source: halos that take the color of their spot, grain that
//! points toward a bolt.
//! @alias gradient falloff glow outline halo geodesic nearest closest source voronoi
//! @use distance

struct Params {
    /// Distance at which the mask has faded out.
    /// @length @range 0.0001 2 @soft 0.005 0.3 @default 0.05
    width: f32,
    /// Values of the mask above this one are inside.
    /// @range 0 1 @default 0.5
    threshold: f32,
}

/// Where the mask's border passes.
/// @pass 1
/// @input source The mask to measure from.
fn border(at: Surface, params: Params, source: texture_2d_array<f32>) -> f32 {
    return distance_start(source, at, params.threshold, 1.0, 1.1 * params.width);
}

/// How far it is, close by.
/// @pass 2 @repeat ceil(3.5 * max(min(params.width / 16, 16 * finest), finest) / finest) + 4
fn close(at: Surface, border: texture_2d_array<f32>) -> f32 {
    return distance_sweep(border, at);
}

/// The same on a level that has some twenty texels for the whole way.
/// @pass 3 @texel min(params.width / 16, 16 * finest)
fn seed(at: Surface, close: texture_2d_array<f32>) -> f32 {
    return surface_here(close, at).x;
}

/// How far it is from everywhere.
/// @pass 4 @texel min(params.width / 16, 16 * finest)
/// @repeat ceil(1.3 * params.width / texel) + 8
fn far(at: Surface, seed: texture_2d_array<f32>) -> f32 {
    return distance_sweep(seed, at);
}

/// Width of the texels of that level.
/// @pass 5 @texel min(params.width / 16, 16 * finest)
fn coarse(at: Surface, round: Round) -> f32 {
    return round.texel;
}

/// 1 on the mask, falling to 0 with the distance from it.
fn mask(
    at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>,
    coarse: texture_2d_array<f32>,
) -> f32 {
    return 1.0 - clamp(away(at, round, params, close, far, coarse) / params.width, 0.0, 1.0);
}

/// Distance to the mask; at most Width.
fn distance(
    at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>,
    coarse: texture_2d_array<f32>,
) -> f32 {
    return min(away(at, round, params, close, far, coarse), params.width);
}

/// Direction over the surface toward the nearest place of the mask, of unit length; 0 on the mask and beyond Width.
/// @vector
fn direction(at: Surface, back: texture_2d_array<f32>) -> vec3f {
    return surface_here(back, at).xyz;
}

/// What Carry holds at the nearest place of the mask, such as a random value of each spot.
fn id(
    at: Surface, params: Params, known: texture_2d_array<f32>, back: texture_2d_array<f32>,
    carried: texture_2d_array<f32>,
) -> f32 {
    // The shortest path is a straight line over the surface (the eikonal equation's characteristics are geodesics), so no
    // value has to be swept along: a walk back finds it. It is corrected on the way, since a small error of the direction
    // is a large one at the end.
    var walk = surface_standing(at);
    var left = surface_here(known, at).x;
    for (var index = 0; index < 5; index++) {
        let heading = unit_or(surface_sample(back, walk).xyz, walk.heading);
        let is_last = index == 4 || left < 4.0 * at.texel_size;
        let stride = select(0.6 * left, left + at.texel_size, is_last);
        walk = surface_walk(walk, heading * select(0.0, stride, left > 0.0));
        left = select(surface_sample(known, walk).x, 0.0, is_last);
    }
    return surface_sample(carried, walk).x;
}

/// The distance, for its slope.
/// @pass 6
fn known(
    at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>,
    coarse: texture_2d_array<f32>,
) -> f32 {
    return min(away(at, round, params, close, far, coarse), params.width);
}

/// Down the slope of the distance.
/// @pass 7 @vector
fn back(at: Surface, params: Params, known: texture_2d_array<f32>) -> vec3f {
    let own = surface_here(known, at).x;
    let slope = surface_gradient(known, at);
    // Between two sources slopes cancel out: there the steepest of eight steps leads to one of them.
    let is_even = dot(slope, slope) > 0.6;
    var best = vec4f(0.0);
    best = steeper(best, known, at, own, vec2i(1, 0));
    best = steeper(best, known, at, own, vec2i(-1, 0));
    best = steeper(best, known, at, own, vec2i(0, 1));
    best = steeper(best, known, at, own, vec2i(0, -1));
    best = steeper(best, known, at, own, vec2i(1, 1));
    best = steeper(best, known, at, own, vec2i(-1, -1));
    best = steeper(best, known, at, own, vec2i(1, -1));
    best = steeper(best, known, at, own, vec2i(-1, 1));
    let way = select(best.xyz, -slope, is_even);
    return select(vec3f(0.0), unit_or(way, vec3f(0.0)), own > 0.0 && own < params.width);
}

// The steeper way down of two, and its steepness: the one before, or that of a step.
fn steeper(best: vec4f, known: texture_2d_array<f32>, at: Surface, own: f32, step: vec2i) -> vec4f {
    let way = at.texel_step * f32(step.x) + at.texel_rise * f32(step.y);
    let fall = (own - surface_neighbor(known, at, step).x) / max(length(way), 1e-12);
    return select(best, vec4f(way, fall), fall > best.w);
}

/// What is carried outward.
/// @pass 8
/// @input carry The mask whose values Id carries outward, such as a random value of each spot. @optional @default 1
fn carried(at: Surface, carry: f32) -> f32 {
    return carry;
}

fn away(
    at: Surface, round: Round, params: Params, close: texture_2d_array<f32>, far: texture_2d_array<f32>,
    coarse: texture_2d_array<f32>,
) -> f32 {
    return distance_known(close, far, coarse, at, clamp(params.width / 16.0, round.finest, 16.0 * round.finest));
}
