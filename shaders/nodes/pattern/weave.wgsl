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

/// The thread of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn thread(at: Surface, position: vec3f, params: Params) -> Thread {
    // Plain cloth repeats itself after two threads, twill after four and satin after five.
    let repeat = select(select(2.0, 4.0, params.kind == 1u), 5.0, params.kind == 2u);
    let found = pattern_place(at, position, params.space, params.rotate, vec2f(params.size * repeat));
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
    let away = 1.0 - q;
    let column = vec3f(cover.x, crown.x, away.x);
    let row = vec3f(cover.y, crown.y, away.y);
    let upper = select(column, row, is_row_up);
    let lower = select(row, column, is_row_up);
    let is_row = is_row_up == (upper.x >= 0.5);
    // By the middle of the texel: a mean of shares would raise the borders of the threads.
    let top = max(select(select(vec3f(0.0), lower, lower.x >= 0.5), upper, upper.x >= 0.5), vec3f(0.0));
    // Upright threads are turned by a right angle: x runs up along them.
    let scale = params.size / select(found.speed.yx, found.speed, is_row);
    let part = fract((select(p.y, p.x, is_row) - hidden_at(square, params.kind, is_row)) / repeat) - 0.5;
    let middle = vec2f(part * repeat, select(-inside.x, inside.y, is_row)) * scale;
    let inward = select(half.x - t.x, half.y - t.y, is_row) * scale.y;
    let turn = select(found.period.y, found.period.x, is_row);
    return Thread(
        mix(lower.x, 1.0, upper.x),
        top.y,
        select(lower.x * (1.0 - upper.x), upper.x, is_row_up),
        top.z,
        PatternCell(middle, 0.5 * scale * vec2f(repeat, 1.0), inward, select(ids.x, ids.y, is_row), found.hand),
        along_of(select(found.place.y, found.place.x, is_row), turn) * scale.x / params.size,
    );
}

/// Threads: 1 on them, 0 in the gaps between.
fn mask(at: Surface, thread: Thread, params: Params) -> f32 {
    return mix(mean_cover(params), thread.cover, seen(at, params));
}

/// How high the threads lie: 0 in the gaps, 1 on top of a thread that runs over others.
fn height(at: Surface, thread: Thread, params: Params) -> f32 {
    // The mean height of what is covered, fitted to what was measured over 200 000 places for each kind.
    let mean = mean_cover(params) * (0.65 + 0.15 * params.thread);
    return mix(mean, thread.height, seen(at, params));
}

/// A random value for each thread.
fn id(thread: Thread) -> f32 {
    return unit_random(thread.cell.id);
}

/// A slight tilt of each thread: 0.5 along its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, thread: Thread, params: Params) -> f32 {
    var cell = thread.cell;
    // A thread has no ends, so it is tilted across only.
    cell.middle.x = 0.0;
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the border of the thread that lies on top: 0 on it and in the gaps, 1 along the middle of a thread.
fn away(at: Surface, thread: Thread, params: Params) -> f32 {
    return mix(0.5 * mean_cover(params), thread.away, seen(at, params));
}

/// The place in each thread, for fibers or a noise that is another one in each: x along it without an end, y from its middle.
/// Threads that close up around a piece go in a circle, so that noises close up too.
/// @vector
fn place(thread: Thread) -> vec3f {
    var cell = thread.cell;
    cell.middle.x = thread.along_it.x;
    return pattern_vector(cell) + vec3f(0.0, 0.0, thread.along_it.y);
}

/// The place across each thread for an image: x from 0 to 1 along it, from the middle of where it is below others to the next
/// one, and y from 0 to 1 across it, with half the gaps beside it.
/// @vector
fn uv(thread: Thread) -> vec3f {
    return clamp(pattern_uv(thread.cell), vec3f(0.0), vec3f(1.0));
}

/// Threads along the rows of the pattern: 1 where they lie on top, 0 where the threads across do.
fn along(at: Surface, thread: Thread, params: Params) -> f32 {
    return mix(mean_along(params), thread.along, seen(at, params));
}

// What is seen at a place.
struct Thread {
    cover: f32,
    height: f32,
    along: f32,
    away: f32,
    // The thread on top, from where it is hidden to where it is again: x along it and y across it.
    cell: PatternCell,
    // How far along the thread the place lies, in the plane and before it; working units.
    along_it: vec2f,
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

// A place along a thread through a square at which the thread lies lowest, in squares.
fn hidden_at(square: vec2i, kind: u32, is_row: bool) -> f32 {
    let number = f32(select(square.x, square.y, is_row));
    switch kind {
        case 1u: { return select(1.0, 3.0, is_row) - number; }
        case 2u: { return select(2.0 * number + 3.0, 0.5 - 2.0 * number, is_row); }
        default: { return select(0.5, 1.5, is_row) + number; }
    }
}

// Rise of a thread at a place between the middles of two squares, from -1 below the others to 1 above them.
fn rise(low: bool, high: bool, t: f32) -> f32 {
    let ends = select(vec2f(-1.0), vec2f(1.0), vec2<bool>(low, high));
    let smooth_t = t * t * (3.0 - 2.0 * t);
    return mix(ends.x, ends.y, smooth_t);
}

// A place along a thread: in the plane, or on a circle as long as a whole turn.
fn along_of(x: f32, turn: f32) -> vec2f {
    let radius = max(turn, 1e-9) / 6.2831853;
    return select(vec2f(x, 0.0), radius * vec2f(sin(x / radius), 1.0 - cos(x / radius)), turn > 0.0);
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
