//! Grid
//! Crossing lines at equal distances on every side of the model: grids, fences, tiled seams, graph paper.
//!
//! Lines thinner than a texel become faint; grids finer than the texels fade to their mean.
//! @alias grid lines mesh net fence square cage wire
//! @use pattern

struct Params {
    /// Distance of neighboring lines.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Width of a line.
    /// @length @range 0 10 @soft 0 0.05 @default 0.008
    width: f32,
    /// Height of a cell as a multiple of its width.
    /// @range 0.05 20 @soft 0.25 4 @default 1
    aspect: f32,
    /// Radius of the rounded edges of a cell, in Height.
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

/// The cell of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> PatternCell {
    let found = pattern_place(at, position, params.space, params.rotate, vec2f(params.size, params.size * params.aspect));
    let scale = vec2f(params.size, params.size * params.aspect);
    return pattern_square_cell(found, pattern_square(found, scale), scale, params.width, params.seed);
}

/// Lines: 1 on them, 0 between.
fn mask(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let cover = pattern_cover(cell, params.width, at.texel_size);
    return mix(mean_lines(params), 1.0 - cover, seen(at, params));
}

/// The rounded surface of a cell: 0 on the lines, 1 on its face.
fn height(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let height = pattern_height(cell, params.bevel, at.texel_size);
    return mix(mean_height(params), height, seen(at, params));
}

/// A random value for each cell.
fn id(cell: PatternCell) -> f32 {
    return unit_random(cell.id);
}

/// A slight tilt of each cell: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the nearest line: 0 on it, 1 in the middle of a cell.
fn away(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let away = pattern_away(cell, params.width);
    return mix(mean_away(params), away, seen(at, params));
}

/// The place in each cell, for a noise or an image that is another one in each.
/// @vector
fn place(cell: PatternCell) -> vec3f {
    return pattern_vector(cell);
}

/// The place across each field for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: PatternCell) -> vec3f {
    return pattern_uv(cell);
}

// The share of lines in the surface.
fn mean_lines(params: Params) -> f32 {
    let share = params.width / params.size;
    return 1.0 - max(1.0 - share, 0.0) * max(1.0 - share / params.aspect, 0.0);
}

// Between the lines, along the rows and across them.
fn inner_of(params: Params) -> vec2f {
    return max(params.size * vec2f(1.0, params.aspect) - params.width, vec2f(1e-9));
}

// Mean of the height: round edges take what a quarter of a circle leaves of its square.
fn mean_height(params: Params) -> f32 {
    let inner = inner_of(params);
    let bevel = min(params.bevel, 0.5 * min(inner.x, inner.y));
    return (1.0 - mean_lines(params)) * (1.0 - 0.43 * bevel * (1.0 / inner.x + 1.0 / inner.y));
}

// Mean of a hipped roof over each cell.
fn mean_away(params: Params) -> f32 {
    let inner = inner_of(params);
    return (1.0 - mean_lines(params)) * (0.5 - min(inner.x, inner.y) / (6.0 * max(inner.x, inner.y)));
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(2.0 * params.size * min(params.aspect, 1.0), at.texel_size);
}
