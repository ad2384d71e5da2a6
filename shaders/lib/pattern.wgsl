//! Regular patterns: where they are laid on a model, and what a texel sees of their cells.
//!
//! A pattern lies on the sides of a model, or of each of its pieces, and goes on around upright corners: all upright sides
//! share the coordinate x - z, along which one side begins where the last one ended, whatever the size of the box. On round
//! bodies it runs around an axis instead, and cells close up to a ring.
//! @use core hash noise atlas

/// Where a pattern is laid: values of `space`.
const SPACE_MODEL: u32 = 0u;
const SPACE_PIECE: u32 = 1u;
const SPACE_AROUND: u32 = 2u;
const SPACE_BALL: u32 = 3u;
const SPACE_UV: u32 = 4u;

/// A place in the plane of a pattern.
struct PatternPlace {
    /// Along the rows and across them, in lengths of the pattern.
    place: vec2f,
    /// Lengths of the pattern for a step of one working unit along the surface, along both axes.
    speed: vec2f,
    /// The plane: sides that do not go on around a corner have patterns of their own.
    side: u32,
    /// 1 where the rows run to the right as seen from outside, -1 where they run to the left.
    hand: f32,
    /// Length of a whole turn around the axis, along the rows or across them; 0 where the pattern does not close up.
    period: vec2f,
}

/// One cell of a pattern. Lengths are working units along the surface.
struct PatternCell {
    /// The place, from the middle of the cell.
    middle: vec2f,
    /// From the middle to the middle of the joint around it.
    half: vec2f,
    /// From the border inward; below 0 in the joint.
    inside: f32,
    /// A random number.
    id: u32,
    /// 1 where the rows run to the right as seen from outside, -1 where they run to the left.
    hand: f32,
}

/// The plane of a pattern, and the place in it. `position` is moved by as much as it differs from the surface's own; `unit`
/// has the lengths along the rows and across them after which a pattern repeats itself, so that it can close up to a ring.
fn pattern_place(at: Surface, position: vec3f, space: u32, rotate: f32, unit: vec2f) -> PatternPlace {
    switch space {
        case SPACE_AROUND: { return pattern_around(at, position, false, rotate, unit); }
        case SPACE_BALL: { return pattern_around(at, position, true, rotate, unit); }
        case SPACE_UV: { return pattern_on_uv(at, position, rotate); }
        default: { return pattern_on_box(at, position, space == SPACE_PIECE, rotate); }
    }
}

// On the sides of the model's box, or of the piece's.
fn pattern_on_box(at: Surface, position: vec3f, in_piece: bool, rotate: f32) -> PatternPlace {
    let p = select(position, at.piece_position + (position - at.position), in_piece);
    let n = select(at.normal, at.piece_normal, in_piece);
    let m = abs(n);
    // Where a side looks along x and against z, or the other way around, x - z would stand still.
    let turned = n.x * n.z < -0.08;
    var along = vec3f(1.0, 0.0, select(-1.0, 1.0, turned));
    var across = vec3f(0.0, 1.0, 0.0);
    var side = select(0u, 1u, turned);
    if m.y > 1.01 * max(m.x, m.z) {
        along = vec3f(1.0, 0.0, 0.0);
        across = vec3f(0.0, 0.0, -1.0);
        side = 2u;
    }
    return pattern_on_plane(p, n, along, across, side, rotate);
}

// On a plane along two directions, as a surface with normal `n` sees it.
fn pattern_on_plane(p: vec3f, n: vec3f, along: vec3f, across: vec3f, side: u32, rotate: f32) -> PatternPlace {
    let turn = turn_of(vec3f(rotate, 0.0, 0.0));
    let first = along * turn.cosine.x + across * turn.sine.x;
    let second = across * turn.cosine.x - along * turn.sine.x;
    var found = PatternPlace(
        vec2f(dot(p, first), dot(p, second)),
        vec2f(length(first - n * dot(first, n)), length(second - n * dot(second, n))),
        side,
        select(1.0, -1.0, dot(cross(along, across), n) < 0.0),
        vec2f(0.0),
    );
    found.speed = max(found.speed, vec2f(0.2));
    return found;
}

// Around the longest side of the piece; around the second one of a ball, whose box is upright. A turn is as long as that of a ball as large as the piece, rounded to whole units.
fn pattern_around(at: Surface, position: vec3f, is_ball: bool, rotate: f32, unit: vec2f) -> PatternPlace {
    let own = at.piece_position + (position - at.position);
    let p = select(own, own.yzx, is_ball);
    let n = select(at.piece_normal, at.piece_normal.yzx, is_ball);
    if !is_ball && abs(n.x) > 0.85 {
        // The ends of a body that is no ball are flat.
        return pattern_on_plane(p, n, vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, sign(n.x)), 2u, rotate);
    }
    let turn = turn_of(vec3f(rotate, 0.0, 0.0));
    let is_across = abs(turn.sine.x) > 0.999;
    let closes = is_across || abs(turn.cosine.x) > 0.999;
    let length_of_unit = select(unit.x, unit.y, is_across);
    let ball = 3.14159265 * at.piece_size;
    let circle = select(ball, length_of_unit * max(round(ball / length_of_unit), 1.0), closes);
    let radius = max(length(p.yz), 1e-6);
    // From the middle of the piece to the place, where the meridians of a ball are as long as they look.
    let far = max(length(p), 1e-6);
    let around = circle * atan2(p.z, p.y + select(0.0, 1e-9, radius <= 1e-6)) / 6.2831853;
    let along_axis = select(p.x, ball * atan2(p.x, radius) / 6.2831853, is_ball);
    let pace = vec2f(
        circle / (6.2831853 * radius),
        select(sqrt(max(1.0 - n.x * n.x, 0.0)), ball / (6.2831853 * far), is_ball),
    );
    let place = vec2f(around, along_axis);
    let first = vec2f(turn.cosine.x, turn.sine.x);
    let second = vec2f(-turn.sine.x, turn.cosine.x);
    return PatternPlace(
        vec2f(dot(place, first), dot(place, second)),
        max(vec2f(length(first * pace), length(second * pace)), vec2f(0.2)),
        0u,
        1.0,
        select(vec2f(0.0), select(vec2f(circle, 0.0), vec2f(0.0, circle), is_across), closes),
    );
}

// Along the texture coordinates: their unit counts as 1.
fn pattern_on_uv(at: Surface, position: vec3f, rotate: f32) -> PatternPlace {
    let moved = position - at.position;
    let steps = max(vec2f(length(at.texel_step), length(at.texel_rise)), vec2f(1e-12));
    let shift = vec2f(dot(moved, at.texel_step) / (steps.x * steps.x), dot(moved, at.texel_rise) / (steps.y * steps.y));
    let place = (at.uv + shift / dispatch.size) * vec2f(1.0, -1.0);
    let pace = 1.0 / (steps * dispatch.size);
    let turn = turn_of(vec3f(rotate, 0.0, 0.0));
    let first = vec2f(turn.cosine.x, turn.sine.x);
    let second = vec2f(-turn.sine.x, turn.cosine.x);
    return PatternPlace(
        vec2f(dot(place, first), dot(place, second)),
        max(vec2f(length(first * pace), length(second * pace)), vec2f(1e-6)),
        3u,
        // v grows downward: to the right and down lies behind, unless the chart is mirrored.
        select(1.0, -1.0, dot(cross(at.texel_step, at.texel_rise), at.face_normal) > 0.0),
        vec2f(0.0),
    );
}

/// Number of cells of a size in a whole turn; 0 where the pattern does not close up.
fn pattern_counts(found: PatternPlace, cell: vec2f) -> vec2i {
    return vec2i(round(found.period / cell));
}

/// The number of a cell, where those after a whole turn are the same again.
fn pattern_wrapped(number: i32, count: i32) -> i32 {
    return select(number, number - count * i32(floor(f32(number) / max(f32(count), 1.0))), count > 0);
}

/// The cell between two borders of a row of them: its number, and where it begins and ends.
struct PatternSpan {
    number: i32,
    low: f32,
    high: f32,
}

/// A border between two cells, moved at random by up to a share of the distance of borders.
fn pattern_border(number: i32, uneven: f32, key: vec3u, count: i32) -> f32 {
    let own = bitcast<u32>(pattern_wrapped(number, count));
    let random = unit_random(pcg3d(vec3u(own, 0x2c1b3c6du, 0x297a2d39u) + key).x);
    return f32(number) + 0.45 * uneven * (2.0 * random - 1.0);
}

/// The span of a row of equal cells, with borders that are moved at random, in which a place lies. `count` cells are a whole
/// turn, 0 if there is none.
fn pattern_span(x: f32, uneven: f32, key: vec3u, count: i32) -> PatternSpan {
    let guess = i32(floor(x));
    let low = pattern_border(guess, uneven, key, count);
    let high = pattern_border(guess + 1, uneven, key, count);
    if x < low {
        return PatternSpan(guess - 1, pattern_border(guess - 1, uneven, key, count), low);
    }
    if x >= high {
        return PatternSpan(guess + 1, high, pattern_border(guess + 2, uneven, key, count));
    }
    return PatternSpan(guess, low, high);
}

/// A rectangle with rounded corners between joints: `low` and `high` are the middles of the joints around it, in lengths of
/// the pattern.
fn pattern_box(found: PatternPlace, low: vec2f, high: vec2f, joint: f32, round: f32, id: u32) -> PatternCell {
    let half = 0.5 * (high - low) / found.speed;
    let middle = (found.place - 0.5 * (low + high)) / found.speed;
    let whole = half - 0.5 * joint;
    let radius = max(min(round, min(whole.x, whole.y)), 0.0);
    let q = abs(middle) - whole + radius;
    let inside = radius - length(max(q, vec2f(0.0))) - min(max(q.x, q.y), 0.0);
    return PatternCell(middle, half, inside, id, found.hand);
}

/// Three numbers to add to a cell before it is hashed: every seed and every plane has cells of its own.
fn pattern_key(found: PatternPlace, seed: u32) -> vec3u {
    return seed_key(seed + found.side * 0x9e3779b9u);
}

/// Random numbers of a cell.
fn pattern_random(found: PatternPlace, column: i32, row: i32, seed: u32) -> vec3u {
    return pcg3d(vec3u(bitcast<u32>(column), bitcast<u32>(row), 0x68e31da4u) + pattern_key(found, seed));
}

/// Shift of regular cells, in cells, so that no joint lies along the middle of a model.
const PATTERN_SHIFT: vec2f = vec2f(0.237, 0.137);

/// Column and row of a grid of equal cells.
fn pattern_square(found: PatternPlace, scale: vec2f) -> vec2f {
    return floor(found.place / scale + PATTERN_SHIFT);
}

/// A cell of a grid of equal cells, by its column and row.
fn pattern_square_cell(found: PatternPlace, number: vec2f, scale: vec2f, joint: f32, seed: u32) -> PatternCell {
    let low = (number - PATTERN_SHIFT) * scale;
    let counts = pattern_counts(found, scale);
    let own = vec2i(pattern_wrapped(i32(number.x), counts.x), pattern_wrapped(i32(number.y), counts.y));
    let id = pattern_random(found, own.x, own.y, seed).z;
    return pattern_box(found, low, low + scale, joint, 0.0, id);
}

/// The share of a texel that lies on a cell and not in the joint around it, however thin the joint is.
fn pattern_cover(cell: PatternCell, joint: f32, texel_size: f32) -> f32 {
    let texel = max(texel_size, 1e-9);
    // At rounded corners the joint is wider.
    let end = cell.inside + max(joint, -2.0 * cell.inside);
    let gap = max(min(0.5 * texel, end) - max(-0.5 * texel, cell.inside), 0.0);
    return 1.0 - gap / texel;
}

/// The rounded profile of a cell: 0 in the joint, 1 from the width of the bevel on.
fn pattern_height(cell: PatternCell, bevel: f32, texel_size: f32) -> f32 {
    let t = clamp(cell.inside / max(max(bevel, 0.5 * texel_size), 1e-9), 0.0, 1.0);
    return sqrt(max(t * (2.0 - t), 0.0));
}

/// Distance to the joint: 0 in it, 1 in the middle of a cell.
fn pattern_away(cell: PatternCell, joint: f32) -> f32 {
    let most = min(cell.half.x, cell.half.y) - 0.5 * joint;
    return clamp(cell.inside / max(most, 1e-9), 0.0, 1.0);
}

/// A plane through the middle of a cell, tilted at random: 0.5 in the middle, 0 to 1 at the corners.
fn pattern_tilt(cell: PatternCell) -> f32 {
    let random = unit_random3(pcg3d(vec3u(cell.id, 0x7feb352du, 0x846ca68bu)));
    let tilted = 0.5 + 0.5 * dot(random.xy - 0.5, cell.middle / max(cell.half, vec2f(1e-9)));
    return clamp(tilted, 0.0, 1.0);
}

/// The place in a cell for images and noises: x and y from its middle, to the right and up as seen from outside, and a depth
/// that is another one for each cell.
fn pattern_vector(cell: PatternCell) -> vec3f {
    return vec3f(cell.middle * vec2f(cell.hand, 1.0), 64.0 * unit_random(cell.id));
}

/// The place across a cell for an image that fills it: 0 to 1 to the right and up as seen from outside, and a random number
/// in z.
fn pattern_uv(cell: PatternCell) -> vec3f {
    let across = cell.middle * vec2f(cell.hand, 1.0) / max(cell.half, vec2f(1e-9));
    return vec3f(0.5 + 0.5 * across, unit_random(cell.id));
}
