//! Checker
//! Squares of two kinds in turn, like a chessboard, on every side of the model and around its corners.
//!
//! Squares smaller than the texels fade to their mean.
//! @alias checker chess squares board test
//! @use pattern

struct Params {
    /// Width of a square.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Height of a square as a multiple of its width.
    /// @range 0.05 20 @soft 0.25 4 @default 1
    aspect: f32,
    /// Radius of the rounded edges of a square, in Height.
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

/// The square of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> Square {
    let found = pattern_place(at, position, params.space, params.rotate, 2.0 * vec2f(params.size, params.size * params.aspect));
    let scale = vec2f(params.size, params.size * params.aspect);
    let number = pattern_square(found, scale);
    return Square(pattern_square_cell(found, number, scale, 0.0, params.seed), vec2i(number));
}

/// Squares: 1 on every other one, 0 on the rest.
fn mask(at: Surface, cell: Square, params: Params) -> f32 {
    let is_odd = (cell.number.x + cell.number.y) % 2 != 0;
    // A border shows as much of the other kind as the texel has of it.
    let own = clamp(cell.found.inside / max(at.texel_size, 1e-9) + 0.5, 0.0, 1.0);
    return mix(0.5, select(1.0 - own, own, is_odd), seen(at, params));
}

/// The rounded surface of a square: 0 along its border, 1 on its face.
fn height(at: Surface, cell: Square, params: Params) -> f32 {
    let height = pattern_height(cell.found, params.bevel, at.texel_size);
    return mix(mean_height(params), height, seen(at, params));
}

/// A random value for each square.
fn id(cell: Square) -> f32 {
    return unit_random(cell.found.id);
}

/// A slight tilt of each square: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: Square, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell.found), seen(at, params));
}

/// Distance to the border: 0 on it, 1 in the middle of a square.
fn away(at: Surface, cell: Square, params: Params) -> f32 {
    let mean = 0.5 - min(params.aspect, 1.0 / params.aspect) / 6.0;
    return mix(mean, pattern_away(cell.found, 0.0), seen(at, params));
}

/// The place in each square, for a noise or an image that is another one in each.
/// @vector
fn place(cell: Square) -> vec3f {
    return pattern_vector(cell.found);
}

/// The place across each field for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: Square) -> vec3f {
    return pattern_uv(cell.found);
}

struct Square {
    found: PatternCell,
    number: vec2i,
}

// Mean of the height: round edges take what a quarter of a circle leaves of its square.
fn mean_height(params: Params) -> f32 {
    let bevel = min(params.bevel / params.size, 0.5 * min(params.aspect, 1.0));
    return 1.0 - 0.43 * bevel * (1.0 + 1.0 / params.aspect);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(params.size * min(params.aspect, 1.0), at.texel_size);
}
