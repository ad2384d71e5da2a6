//! Weave
//! Threads that cross over and under each other: canvas, denim, baskets, carbon fiber.
//!
//! Connect Height to the height map of a layer, and Id to a color gradient for threads of different tones. Threads thinner
//! than the texels fade to their mean.
//! @alias cloth fabric canvas denim twill satin basket wicker carbon fiber textile thread linen
//! @use pattern

struct Params {
    /// Distance of neighboring threads.
    /// @length @range 0.0001 100 @soft 0.002 0.1 @default 0.02
    size: f32,
    /// Width of a thread as a share of the distance.
    /// @range 0.05 1 @default 0.85
    thread: f32,
    /// Kind of cloth: over one and under one, over two and under two in slanted lines, or over four and under one.
    /// @choice plain twill satin @default plain
    kind: u32,
    /// Irregularity: how much threads wander and differ in width.
    /// @range 0 1 @default 0.1
    uneven: f32,
    /// What the pattern is laid on: the sides of the whole model, those of each piece, around the longest side of each piece as
    /// on barrels and columns, around a ball, or the texture coordinates, whose unit counts as 1. Around a piece patterns
    /// close up where Rotate is a multiple of 90°; lengths around it are those on a ball as large as the piece.
    /// @choice model piece around ball uv @default model
    space: u32,
    /// Turns the pattern in its plane.
    /// @angle @range -360 360 @soft -180 180 @default 0
    rotate: f32,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// Threads: 1 on them, 0 in the gaps between.
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    return mix(mean_cover(params), thread_at(at, position, params).cover, seen(at, params));
}

/// How high the threads lie: 0 in the gaps, 1 on top of a thread that runs over others.
fn height(at: Surface, position: vec3f, params: Params) -> f32 {
    let thread = thread_at(at, position, params);
    // The mean height of what is covered, fitted to what was measured over 200 000 places for each kind.
    let mean = mean_cover(params) * (0.65 + 0.15 * params.thread);
    return mix(mean, thread.height, seen(at, params));
}

/// A random value for each thread.
fn id(at: Surface, position: vec3f, params: Params) -> f32 {
    return thread_at(at, position, params).id;
}

/// Threads along the rows of the pattern: 1 where they lie on top, 0 where the threads across do.
fn along(at: Surface, position: vec3f, params: Params) -> f32 {
    return mix(mean_along(params), thread_at(at, position, params).along, seen(at, params));
}

// What is seen at a place.
struct Thread {
    cover: f32,
    height: f32,
    id: f32,
    along: f32,
}

// Where a thread across the others lies: on them at the middle of every square that `is_over`.
fn is_over(square: vec2i, kind: u32) -> bool {
    switch kind {
        case 1u: { return ((square.x + square.y) & 3) < 2; }
        case 2u: {
            let step = square.x + 2 * square.y;
            return step - 5 * i32(floor(f32(step) / 5.0)) != 0;
        }
        default: { return ((square.x + square.y) & 1) == 0; }
    }
}

// Rise of a thread at a place between the middles of two squares, from -1 below the others to 1 above them.
fn rise(low: bool, high: bool, t: f32) -> f32 {
    let ends = select(vec2f(-1.0), vec2f(1.0), vec2<bool>(low, high));
    let smooth_t = t * t * (3.0 - 2.0 * t);
    return mix(ends.x, ends.y, smooth_t);
}

fn thread_at(at: Surface, position: vec3f, params: Params) -> Thread {
    // Plain cloth repeats itself after two threads, twill after four and satin after five.
    let repeat = vec2f(select(select(2.0, 4.0, params.kind == 1u), 5.0, params.kind == 2u));
    let found = pattern_place(at, position, params.space, params.rotate, params.size * repeat);
    let p = found.place / params.size + PATTERN_SHIFT;
    let key = pattern_key(found, params.seed);
    // Threads that wander: by simplex noise along each thread, another one for each.
    let square = vec2i(floor(p));
    let counts = pattern_counts(found, vec2f(params.size));
    let own = vec2u(vec2i(pattern_wrapped(square.x, counts.x), pattern_wrapped(square.y, counts.y)));
    let ids = vec2u(pcg3d(vec3u(own.x, 1u, 7u) + key).x, pcg3d(vec3u(own.y, 2u, 9u) + key).x);
    let wander = 0.3 * params.uneven * vec2f(
        simplex_noise(vec3f(0.35 * p.y, 4.0 * unit_random(ids.x), 0.5), key),
        simplex_noise(vec3f(0.35 * p.x, 4.0 * unit_random(ids.y), 0.9), key),
    );
    let inside = p - vec2f(square) - 0.5 - wander * (1.0 - params.thread);
    let spread = 1.0 - 0.5 * params.uneven * vec2f(unit_random(ids.x * 747796405u), unit_random(ids.y * 747796405u));
    let half = 0.5 * params.thread * spread;
    // The profile across each thread: upright ones (x) and those along the rows (y).
    let q = abs(inside) / half;
    let round = sqrt(max(vec2f(1.0) - q * q, vec2f(0.0)));
    let texel = at.texel_size * found.speed / params.size;
    let cover = clamp((half - abs(inside)) / max(texel, vec2f(1e-6)) + 0.5, vec2f(0.0), vec2f(1.0));
    // The thread along the row rises over the upright ones at the middles of the squares.
    let step = select(vec2i(-1), vec2i(1), inside > vec2f(0.0));
    let t = abs(inside);
    let here = is_over(square, params.kind);
    let beside = is_over(square + vec2i(step.x, 0), params.kind);
    let above = is_over(square + vec2i(0, step.y), params.kind);
    let row_rise = rise(here, beside, t.x);
    let column_rise = -rise(here, above, t.y);
    // Crowns of both threads; the borders of the upper one let the lower one be seen as far as they cover a texel.
    let crown = vec2f(0.25 * column_rise, 0.25 * row_rise) + 0.25 + 0.5 * round;
    let is_row_up = row_rise >= column_rise;
    let upper = select(vec2f(cover.x, crown.x), vec2f(cover.y, crown.y), is_row_up);
    let lower = select(vec2f(cover.y, crown.y), vec2f(cover.x, crown.x), is_row_up);
    let is_row = is_row_up == (upper.x >= 0.5);
    return Thread(
        mix(lower.x, 1.0, upper.x),
        // By the middle of the texel: a mean of shares would raise the borders of the threads.
        max(select(select(0.0, lower.y, lower.x >= 0.5), upper.y, upper.x >= 0.5), 0.0),
        unit_random(select(ids.x, ids.y, is_row)),
        select(lower.x * (1.0 - upper.x), upper.x, is_row_up),
    );
}

// The share of threads in the surface.
fn mean_cover(params: Params) -> f32 {
    let width = params.thread * (1.0 - 0.25 * params.uneven);
    return 1.0 - (1.0 - width) * (1.0 - width);
}

// The share in which threads along the rows lie on top, fitted likewise.
fn mean_along(params: Params) -> f32 {
    return mean_cover(params) * select(0.5, 0.41 + 0.375 * params.thread, params.kind == 2u);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(2.0 * params.size, at.texel_size);
}
