//! Fracture
//! Flat faces broken off the edges in three sizes: stone, concrete, brick, ceramics, wood.
//!
//! Edge takes the distance from the edges: put Distance behind Edges, and connect its output Distance. The Width of Edges
//! should be a little more than the edges are rounded, and that of Distance more than the breaks reach. Every break is a
//! wedge between planes, one across the edge and others at its ends, so both sides of an edge are cut alike, and the faces
//! meet in sharp lines. Smaller breaks also nibble at the borders of larger ones.
//! @alias broken edges chip facet damage cut stone concrete spall splinter rubble crumble arris
//! @use cells surface

struct Params {
    /// Length of the largest breaks.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.16
    size: f32,
    /// Depth of the largest breaks at the edge.
    /// @length @range 0 100 @soft 0 0.1 @default 0.03
    depth: f32,
    /// How often the largest breaks occur.
    /// @range 0 1 @default 0.45
    big: f32,
    /// How often breaks of the middle size occur.
    /// @range 0 1 @default 0.45
    mid: f32,
    /// How often the smallest breaks occur.
    /// @range 0 1 @default 0.5
    small: f32,
    /// How steep the faces are: 1 cuts a right angle evenly, less reaches further from the edge.
    /// @range 0.1 4 @default 0.7
    steep: f32,
    /// How differently the faces are tilted along the edge.
    /// @range 0 1 @default 0.6
    slant: f32,
    /// Width of the line along the borders of the breaks.
    /// @length @range 0 1 @soft 0 0.02 @default 0.003
    rim: f32,
    /// Stretches the breaks along the axes of the pattern, as splinters of wood.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of breaks.
    /// @seed @default 0
    seed: u32,
}

/// A place in the breaks.
struct Break {
    /// Depth of the deepest break; below 0 how far the surface is from being cut.
    depth: f32,
    /// Random number of the face.
    face: u32,
}

/// Length of the cubes in lengths of a break: with one break in each, they meet but do not fill the edge.
const SPACING: f32 = 1.1;
/// Sizes of the three kinds of breaks.
const SIZES: vec3f = vec3f(1.0, 0.42, 0.17);

// The breaks of one size, united with those that are known. `away` is the distance from what they break off.
fn broken(
    known: Break, at: Surface, position: vec3f, away: f32, scale: f32, amount: f32, level: u32, params: Params,
) -> Break {
    // Breaks of a few texels grow shallow instead of breaking into dots.
    let shown = carried(0.5 * params.size * scale * finest_stretch(params.stretch), at.texel_size);
    let wide = 0.85 * params.depth * scale / params.steep * shown;
    if amount <= 0.0 || wide <= 0.0 || away > 2.0 * wide + params.rim {
        return known;
    }
    let length = SPACING * params.size * scale;
    let place = cells_place(position, length, params.stretch, params.rotate);
    let key = seed_key(params.seed + 101u * level);
    let cell = cell_of(place);
    var found = known;
    for (var index = 0; index < 27; index++) {
        let step = vec3i(index % 3, (index / 3) % 3, index / 9) - 1;
        let random = cell_random(cell + step, key);
        let offset = place - vec3f(cell + step) - cell_point(random, 1.0);
        // Nothing reaches further than 0.95 of a cube.
        if dot(offset, offset) < 0.9 {
            let more = pcg3d(random ^ vec3u(0x3c6ef372u));
            // Fewer than asked for occur near an edge, so the chance rises faster.
            if unit_random(more.z) < amount * (2.0 - amount) {
                let cut = wedge(offset, away, wide, length * shown, more, params);
                if cut.depth > found.depth {
                    found = cut;
                }
            }
        }
    }
    return found;
}

// One break: the least of planes is a wedge.
fn wedge(offset: vec3f, away: f32, wide: f32, length: f32, random: vec3u, params: Params) -> Break {
    let kinds = unit_random3(pcg3d(random));
    let first = unit_random3(pcg3d(random ^ vec3u(0x9e3779b9u))) - 0.5;
    let axis = first * inverseSqrt(max(dot(first, first), 1e-6));
    let lean = unit_random3(pcg3d(random ^ vec3u(0x7f4a7c15u))) - 0.5;
    let side = cross(axis, lean);
    let across = side * inverseSqrt(max(dot(side, side), 1e-6));
    let ends = vec3f(dot(offset, axis), dot(offset, across), dot(offset, cross(axis, across)));
    let reach = wide * (0.45 + 0.55 * kinds.x);
    // The face along the edge, tilted; in working units.
    let face = params.steep * (reach - away + 2.4 * params.slant * wide * dot(lean, offset));
    // The faces at its ends: a box of its own size, whose corners are inside of the reach.
    let half = vec3f(0.3, 0.36, 0.42) + 0.12 * kinds;
    let rest = (half - abs(ends)) * (length * params.steep * (0.45 + 0.5 * kinds.zxy));
    let depth = min(face, min(rest.x, min(rest.y, rest.z)));
    var which = 0u;
    which = select(which, select(1u, 2u, ends.x > 0.0), depth == rest.x);
    which = select(which, select(3u, 4u, ends.y > 0.0), depth == rest.y);
    which = select(which, select(5u, 6u, ends.z > 0.0), depth == rest.z);
    return Break(depth, random.x ^ (which * 0x85ebca6bu));
}

/// The distance from the edges.
/// @pass 1
/// @input edge Distance from the nearest edge, in model units: the output Distance of Distance behind Edges. Where it stays the same all around, there is no edge. Zero breaks the surface everywhere. @optional @default 0
fn known_edge(edge: f32) -> f32 {
    return max(edge, 0.0);
}

// Whether a distance is the same all around, as beyond the width that it is measured to: no edge is known there.
fn is_even(away: f32, at: Surface, known_edge: texture_2d_array<f32>) -> bool {
    let step = max(0.125 * away, 2.0 * at.texel_size);
    let right = unit_or(at.texel_step, vec3f(1.0, 0.0, 0.0)) * step;
    let down = unit_or(cross(at.normal, right), vec3f(0.0, 1.0, 0.0)) * step;
    var most = abs(surface_sample(known_edge, surface_walk(surface_standing(at), right)).x - away);
    most = max(most, abs(surface_sample(known_edge, surface_walk(surface_standing(at), -right)).x - away));
    most = max(most, abs(surface_sample(known_edge, surface_walk(surface_standing(at), down)).x - away));
    most = max(most, abs(surface_sample(known_edge, surface_walk(surface_standing(at), -down)).x - away));
    return most < 1e-3 * step;
}

/// Depth of the deepest break, below 0 how far the surface is from being cut; a random value for its face.
/// @pass 2 @vector
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn breaks(at: Surface, params: Params, known_edge: texture_2d_array<f32>, position: vec3f) -> vec3f {
    let none = Break(-1e6, 0u);
    let away = surface_here(known_edge, at).x;
    let widest = 1.7 * params.depth / params.steep + params.rim;
    if away > 0.0 && away < widest && is_even(away, at, known_edge) {
        return vec3f(none.depth, 0.0, 0.0);
    }
    let large = broken(none, at, position, away, SIZES.x, params.big, 0u, params);
    // The border of a larger break is a new edge, though a blunter one.
    let large_away = min(away, 1.5 * abs(large.depth) / params.steep + 0.1 * params.size * SIZES.y);
    let middle = broken(large, at, position, large_away, SIZES.y, params.mid, 1u, params);
    let middle_away = min(away, 1.5 * abs(middle.depth) / params.steep + 0.1 * params.size * SIZES.z);
    let all = broken(middle, at, position, middle_away, SIZES.z, params.small, 2u, params);
    return vec3f(all.depth, unit_random(pcg3d(vec3u(all.face)).y), 0.0);
}

/// 1 on the fresh faces of breaks.
fn mask(at: Surface, params: Params, breaks: texture_2d_array<f32>) -> f32 {
    return clamp(surface_here(breaks, at).x / (params.steep * at.texel_size) + 0.5, 0.0, 1.0);
}

/// Height of the broken faces, below 0.
fn height(at: Surface, breaks: texture_2d_array<f32>) -> f32 {
    return -max(surface_here(breaks, at).x, 0.0);
}

/// A random value for each face, 0 where nothing is broken.
fn id(at: Surface, breaks: texture_2d_array<f32>) -> f32 {
    let found = surface_here(breaks, at);
    return select(0.0, found.y, found.x > 0.0);
}

/// The line along the borders of the breaks, on both sides.
fn rim(at: Surface, params: Params, breaks: texture_2d_array<f32>) -> f32 {
    let away = abs(surface_here(breaks, at).x) / params.steep;
    let width = max(0.5 * params.rim, 0.5 * at.texel_size);
    return clamp(1.0 - away / width, 0.0, 1.0) * min(params.rim / at.texel_size, 1.0);
}
