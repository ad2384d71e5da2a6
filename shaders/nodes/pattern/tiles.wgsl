//! Tiles
//! Square or rectangular tiles: in a grid, in herringbone, or woven like a basket; on every side of the model.
//!
//! Herringbone and basket take tiles twice as long as they are wide: Width is their short side. Tiles smaller than the
//! texels fade to their mean.
//! @alias tile floor pavement parquet herringbone basket mosaic slab grout grid square
//! @use pattern

struct Params {
    /// Width of a tile, from joint to joint.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    width: f32,
    /// Height of a tile as a multiple of its width; only in the grid.
    /// @range 0.05 20 @soft 0.25 4 @default 1
    aspect: f32,
    /// How the tiles are laid.
    /// @choice grid herringbone basket @default grid
    laid: u32,
    /// Width of a joint.
    /// @length @range 0 10 @soft 0 0.05 @default 0.006
    joint: f32,
    /// Radius of the rounded corners and edges.
    /// @length @range 0 10 @soft 0 0.05 @default 0.004
    bevel: f32,
    /// Irregularity: how much tiles in the grid differ in size.
    /// @range 0 1 @default 0
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

/// The tile of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> PatternCell {
    // Herringbone and basket repeat themselves after four short sides.
    let is_grid = params.laid == 0u;
    let scale = select(vec2f(params.width), vec2f(params.width, params.width * params.aspect), is_grid);
    let unit = scale * select(4.0, 1.0, is_grid);
    let found = pattern_place(at, position, params.space, params.rotate, unit);
    let key = pattern_key(found, params.seed);
    let counts = pattern_counts(found, scale);
    var low: vec2f;
    var high: vec2f;
    var number: vec2i;
    if is_grid {
        let p = found.place / scale + PATTERN_SHIFT;
        let rows = pattern_span(p.y, 0.6 * params.uneven, key, counts.y);
        let columns = pattern_span(p.x, 0.6 * params.uneven, key.yzx, counts.x);
        low = vec2f(columns.low, rows.low);
        high = vec2f(columns.high, rows.high);
        number = vec2i(columns.number, rows.number);
    } else {
        let p = found.place / scale + PATTERN_SHIFT;
        let square = vec2i(floor(p));
        var first = square;
        var lies = true;
        if params.laid == 1u {
            // Along a diagonal of squares: two of a tile that lies, two of one that stands.
            let place = (square.x - square.y) & 3;
            lies = place < 2;
            first.x -= select(0, 1, place == 1);
            first.y -= select(0, 1, place == 2);
        } else {
            lies = (((square.x >> 1u) + (square.y >> 1u)) & 1) == 0;
            first = select(vec2i(square.x, square.y & -2), vec2i(square.x & -2, square.y), lies);
        }
        low = vec2f(first);
        high = low + select(vec2f(1.0, 2.0), vec2f(2.0, 1.0), lies);
        number = first;
    }
    let own = vec2i(pattern_wrapped(number.x, counts.x), pattern_wrapped(number.y, counts.y));
    let id = pattern_random(found, own.x, own.y, params.seed).z;
    return pattern_box(found, (low - PATTERN_SHIFT) * scale, (high - PATTERN_SHIFT) * scale, params.joint, params.bevel, id);
}

/// Tiles: 1 on them, 0 in the joints.
fn mask(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let cover = pattern_cover(cell, params.joint, at.texel_size);
    return mix(mean_cover(params), cover, seen(at, params));
}

/// The rounded surface of a tile: 0 in the joints, 1 on its face.
fn height(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let height = pattern_height(cell, params.bevel, at.texel_size);
    return mix(mean_cover(params), height, seen(at, params));
}

/// A random value for each tile.
fn id(cell: PatternCell) -> f32 {
    return unit_random(cell.id);
}

/// A slight tilt of each tile: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the joint: 0 in it, 1 in the middle of a tile.
fn away(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5 * mean_cover(params), pattern_away(cell, params.joint), seen(at, params));
}

/// The place in each tile, for a noise or an image that is another one on each.
/// @vector
fn place(cell: PatternCell) -> vec3f {
    return pattern_vector(cell);
}

/// The place across each tile for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: PatternCell) -> vec3f {
    return pattern_uv(cell);
}

// The share of tiles in the surface.
fn mean_cover(params: Params) -> f32 {
    let aspect = select(2.0, params.aspect, params.laid == 0u);
    let share = params.joint / params.width;
    return max(1.0 - share, 0.0) * max(1.0 - share / aspect, 0.0);
}

fn seen(at: Surface, params: Params) -> f32 {
    let aspect = select(1.0, params.aspect, params.laid == 0u);
    return carried(2.0 * params.width * min(aspect, 1.0), at.texel_size);
}
