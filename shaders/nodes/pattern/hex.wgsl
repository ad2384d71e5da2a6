//! Hexagons
//! A honeycomb of hexagonal tiles on every side of the model.
//!
//! Tiles smaller than the texels fade to their mean.
//! @alias hex hexagon honeycomb tile bathroom floor scales
//! @use pattern

struct Params {
    /// Width of a hexagon between two parallel sides, from joint to joint.
    /// @length @range 0.0001 100 @soft 0.01 0.3 @default 0.06
    size: f32,
    /// Width of a joint.
    /// @length @range 0 10 @soft 0 0.05 @default 0.005
    joint: f32,
    /// Radius of the rounded corners and edges.
    /// @length @range 0 10 @soft 0 0.05 @default 0.004
    bevel: f32,
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

/// The tile of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> PatternCell {
    let found = pattern_place(at, position, params.space, params.rotate, params.size * ROW);
    let p = found.place / params.size + PATTERN_SHIFT;
    // Two grids of middles, of which the nearer one counts.
    let first = round(p / ROW);
    let second = floor(p / ROW);
    let from_first = p - first * ROW;
    let from_second = p - (second + 0.5) * ROW;
    let is_second = dot(from_second, from_second) < dot(from_first, from_first);
    let q = select(from_first, from_second, is_second);
    let number = vec2i(select(first, second, is_second)) * 2 + select(0, 1, is_second);
    let middle = q * params.size / found.speed;
    let half = vec2f(0.5, 0.57735027) * params.size / found.speed;
    // The nearest of the six sides; a rounded corner is as far from the middle as its arc. On a slope a pattern runs slower
    // along one axis, and the way to a side is longer by as much as the side faces along it.
    let a = abs(q) * params.size;
    let pace = vec2f(found.speed.x, length(vec2f(0.5, 0.8660254) * found.speed));
    let to_sides = (0.5 * params.size - vec2f(a.x, 0.5 * a.x + 0.8660254 * a.y)) / pace - 0.5 * params.joint;
    let radius = max(min(params.bevel, 0.5 * (params.size / max(pace.x, pace.y) - params.joint)), 0.0);
    let sides = radius - to_sides;
    // Two sides that meet at 120° make a corner at this distance from where both end.
    let both = max(sides, vec2f(0.0));
    let corner = sqrt(max((both.x * both.x + both.y * both.y - both.x * both.y) * 1.3333333, 0.0));
    let rounded = select(max(sides.x, sides.y), corner, min(2.0 * both.x - both.y, 2.0 * both.y - both.x) > 0.0);
    let counts = 2 * pattern_counts(found, params.size * ROW);
    let id = pattern_random(found, pattern_wrapped(number.x, counts.x), pattern_wrapped(number.y, counts.y), params.seed).z;
    return PatternCell(middle, half, radius - rounded, id, found.hand);
}

/// Hexagons: 1 on them, 0 in the joints.
fn mask(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let cover = pattern_cover(cell, params.joint, at.texel_size);
    return mix(mean_cover(params), cover, seen(at, params));
}

/// The rounded surface of a hexagon: 0 in the joints, 1 on its face.
fn height(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let height = pattern_height(cell, params.bevel, at.texel_size);
    return mix(mean_cover(params), height, seen(at, params));
}

/// A random value for each hexagon.
fn id(cell: PatternCell) -> f32 {
    return unit_random(cell.id);
}

/// A slight tilt of each hexagon: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the joint: 0 in it, 1 in the middle of a hexagon.
fn away(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5 * mean_cover(params), pattern_away(cell, params.joint), seen(at, params));
}

/// The place in each hexagon, for a noise or an image that is another one on each.
/// @vector
fn place(cell: PatternCell) -> vec3f {
    return pattern_vector(cell);
}

/// The place across each hexagon for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: PatternCell) -> vec3f {
    return pattern_uv(cell);
}

// From the middle of a hexagon of width 1 to that of the next one in its row, and to the row above.
const ROW: vec2f = vec2f(1.0, 1.7320508);

// The share of hexagons in the surface.
fn mean_cover(params: Params) -> f32 {
    let share = max(1.0 - params.joint / params.size, 0.0);
    return share * share;
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(2.0 * params.size, at.texel_size);
}
