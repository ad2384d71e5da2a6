//! Bricks
//! Bricks or blocks in a bond, laid on every side of the model and around its corners.
//!
//! Rows run across the sides of the model; the bricks at an upright corner are seen from both sides. Connect Height to the
//! height map of a layer, Id to a color gradient for bricks of different tones, and Place to the position of a noise for
//! a surface of its own on each brick. Bricks smaller than the texels fade to their mean.
//! @alias brick masonry wall block bond stretcher course pavement stone mortar
//! @use pattern

struct Params {
    /// Length of a brick, from joint to joint.
    /// @length @range 0.0001 100 @soft 0.02 0.5 @default 0.16
    length: f32,
    /// Height of a row, from joint to joint.
    /// @label Height @length @range 0.0001 100 @soft 0.01 0.2 @default 0.06
    row_height: f32,
    /// Width of a joint.
    /// @length @range 0 10 @soft 0 0.05 @default 0.008
    joint: f32,
    /// How the rows are laid: each moved by half a brick, not moved, moved by a third, with a short brick after every long one
    /// in each row, or with a row of short bricks after every row of long ones.
    /// @choice running stack third flemish english @default running
    bond: u32,
    /// Radius of the rounded corners and edges.
    /// @length @range 0 10 @soft 0 0.05 @default 0.006
    bevel: f32,
    /// Irregularity: how much bricks differ in size.
    /// @range 0 1 @default 0.15
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

/// The brick of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> PatternCell {
    // Bonds repeat themselves after a pair of bricks, and after two or three rows.
    let across = select(select(2.0, 3.0, params.bond == 2u), 1.0, params.bond == 1u);
    let repeat = vec2f(select(1.0, 1.5, params.bond == 3u), across);
    let found = pattern_place(at, position, params.space, params.rotate, repeat * vec2f(params.length, params.row_height));
    // So that no joint lies along the middle of the model.
    let x = found.place.x / params.length + 0.237;
    let y = found.place.y / params.row_height + 0.137;
    let key = pattern_key(found, params.seed);
    let scale = vec2f(params.length, params.row_height);
    let counts = pattern_counts(found, scale * vec2f(repeat.x, 1.0));
    let rows = pattern_span(y, 0.5 * params.uneven, key, counts.y);
    let row = pattern_wrapped(rows.number, counts.y);
    let odd = f32(row & 1);
    // Rows that are moved by more than the bond does, where bricks are uneven.
    let moved = params.uneven * unit_random(pcg3d(vec3u(bitcast<u32>(row), 0x1b873593u, 0xcc9e2d51u) + key).y) * 0.3;
    var shift = moved;
    var unit = 1.0;
    switch params.bond {
        case 0u: { shift += 0.5 * odd; }
        case 2u: { shift += f32(row - 3 * i32(floor(f32(row) / 3.0))) / 3.0; }
        case 3u: { shift += 0.75 * odd; }
        case 4u: {
            shift += 0.25 * odd;
            unit = select(1.0, 0.5, odd > 0.5);
        }
        default: {}
    }
    let along = x + shift;
    let row_key = key + vec3u(bitcast<u32>(row) * 0x85ebca6bu, 0u, 0xc2b2ae35u);
    // Two bricks in each pair of the Flemish bond, and twice as many short ones in rows of them.
    let count = counts.x * select(1, 2, params.bond == 3u || unit < 1.0);
    var columns = pattern_span(along / unit, 0.6 * params.uneven, row_key, count);
    columns.low *= unit;
    columns.high *= unit;
    if params.bond == 3u {
        columns = flemish_span(along, 0.6 * params.uneven, row_key, count);
    }
    let offset = vec2f(0.237 + shift, 0.137);
    let low = (vec2f(columns.low, rows.low) - offset) * scale;
    let high = (vec2f(columns.high, rows.high) - offset) * scale;
    let id = pattern_random(found, pattern_wrapped(columns.number, count), row, params.seed).z;
    return pattern_box(found, low, high, params.joint, params.bevel, id);
}

/// Bricks: 1 on them, 0 in the joints.
fn mask(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let cover = pattern_cover(cell, params.joint, at.texel_size);
    return mix(mean_cover(params), cover, seen(at, params));
}

/// The rounded surface of a brick: 0 in the joints, 1 on its face.
fn height(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let height = pattern_height(cell, params.bevel, at.texel_size);
    return mix(mean_cover(params), height, seen(at, params));
}

/// A random value for each brick.
fn id(cell: PatternCell) -> f32 {
    return unit_random(cell.id);
}

/// A slight tilt of each brick: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the joint: 0 in it, 1 in the middle of a brick.
fn away(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5 * mean_cover(params), pattern_away(cell, params.joint), seen(at, params));
}

/// The place in each brick, for a noise or an image that is another one on each.
/// @vector
fn place(cell: PatternCell) -> vec3f {
    return pattern_vector(cell);
}

/// The place across each brick for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: PatternCell) -> vec3f {
    return pattern_uv(cell);
}

// The span of a row in which a brick of half the length follows each long one. Borders are moved as in other rows, by half
// as much.
fn flemish_span(along: f32, uneven: f32, key: vec3u, count: i32) -> PatternSpan {
    let pair = floor(along / 1.5);
    let guess = 2 * i32(pair) + select(0, 1, along - 1.5 * pair >= 1.0);
    let low = flemish_border(guess, uneven, key, count);
    let high = flemish_border(guess + 1, uneven, key, count);
    if along < low {
        return PatternSpan(guess - 1, flemish_border(guess - 1, uneven, key, count), low);
    }
    if along >= high {
        return PatternSpan(guess + 1, high, flemish_border(guess + 2, uneven, key, count));
    }
    return PatternSpan(guess, low, high);
}

fn flemish_border(number: i32, uneven: f32, key: vec3u, count: i32) -> f32 {
    let even = 0.75 * f32(number) + 0.25 * f32(number & 1);
    return even + 0.5 * (pattern_border(number, uneven, key, count) - f32(number));
}

// The share of bricks in the surface.
fn mean_cover(params: Params) -> f32 {
    return max(1.0 - params.joint / params.length, 0.0) * max(1.0 - params.joint / params.row_height, 0.0);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(2.0 * min(0.5 * params.length, params.row_height), at.texel_size);
}
