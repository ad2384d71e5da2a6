//! Regular patterns: where they are laid on a model, and what a texel sees of their cells.
//!
//! A pattern lies on the sides of a model, or of each of its pieces, and goes on around upright corners: all upright sides
//! share the coordinate x - z, along which one side begins where the last one ended, whatever the size of the box.
//! @use core hash noise

/// Where a pattern is laid: values of `space`.
const SPACE_MODEL: u32 = 0u;
const SPACE_PIECE: u32 = 1u;

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

/// The plane of a pattern, and the place in it. `position` is moved by as much as it differs from the surface's own.
fn pattern_place(at: Surface, position: vec3f, space: u32, rotate: f32) -> PatternPlace {
    let in_piece = space == SPACE_PIECE;
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
    let turn = turn_of(vec3f(rotate, 0.0, 0.0));
    let first = along * turn.cosine.x + across * turn.sine.x;
    let second = across * turn.cosine.x - along * turn.sine.x;
    var found = PatternPlace(
        vec2f(dot(p, first), dot(p, second)),
        vec2f(length(first - n * dot(first, n)), length(second - n * dot(second, n))),
        side,
        select(1.0, -1.0, dot(cross(along, across), n) < 0.0),
    );
    found.speed = max(found.speed, vec2f(0.2));
    return found;
}

/// The cell between two borders of a row of them: its number, and where it begins and ends.
struct PatternSpan {
    number: i32,
    low: f32,
    high: f32,
}

/// A border between two cells, moved at random by up to a share of the distance of borders.
fn pattern_border(number: i32, uneven: f32, key: vec3u) -> f32 {
    let random = unit_random(pcg3d(vec3u(bitcast<u32>(number), 0x2c1b3c6du, 0x297a2d39u) + key).x);
    return f32(number) + 0.45 * uneven * (2.0 * random - 1.0);
}

/// The span of a row of equal cells, with borders that are moved at random, in which a place lies.
fn pattern_span(x: f32, uneven: f32, key: vec3u) -> PatternSpan {
    let guess = i32(floor(x));
    let low = pattern_border(guess, uneven, key);
    let high = pattern_border(guess + 1, uneven, key);
    if x < low {
        return PatternSpan(guess - 1, pattern_border(guess - 1, uneven, key), low);
    }
    if x >= high {
        return PatternSpan(guess + 1, high, pattern_border(guess + 2, uneven, key));
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
    let id = pattern_random(found, i32(number.x), i32(number.y), seed).z;
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
