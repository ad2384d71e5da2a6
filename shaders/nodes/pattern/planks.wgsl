//! Planks
//! Long boards side by side, each row cut in other places: floors, fences, board marks in concrete.
//!
//! Planks run across the sides of the model; turn them by 90° for upright boards. With Space at piece they run along the
//! longest side of every piece. Connect Place to the position of Wood for a grain of its own on each plank. Planks narrower
//! than the texels fade to their mean.
//! @alias plank board floor parquet deck fence siding strip formwork wood
//! @use pattern

struct Params {
    /// Width of a plank, from joint to joint.
    /// @length @range 0.0001 100 @soft 0.02 0.3 @default 0.08
    width: f32,
    /// Mean length of a plank.
    /// @length @range 0.0001 100 @soft 0.1 2 @default 0.6
    length: f32,
    /// Width of a joint.
    /// @length @range 0 10 @soft 0 0.05 @default 0.004
    joint: f32,
    /// Radius of the rounded corners and edges.
    /// @length @range 0 10 @soft 0 0.05 @default 0.003
    bevel: f32,
    /// Irregularity: how much planks differ in size.
    /// @range 0 1 @default 0.4
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

/// The plank of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn cell(at: Surface, position: vec3f, params: Params) -> PatternCell {
    let found = pattern_place(at, position, params.space, params.rotate, vec2f(params.length, params.width));
    let key = pattern_key(found, params.seed);
    let scale = vec2f(params.length, params.width);
    let counts = pattern_counts(found, scale);
    let rows = pattern_span(found.place.y / params.width + 0.137, 0.3 * params.uneven, key, counts.y);
    let row = pattern_wrapped(rows.number, counts.y);
    let row_key = key + vec3u(bitcast<u32>(row) * 0x85ebca6bu, 0u, 0xc2b2ae35u);
    // Every row begins elsewhere.
    let shift = 16.0 * unit_random(pcg3d(row_key).x);
    let columns = pattern_span(found.place.x / params.length + shift, params.uneven, row_key, counts.x);
    let offset = vec2f(shift, 0.137);
    let low = (vec2f(columns.low, rows.low) - offset) * scale;
    let high = (vec2f(columns.high, rows.high) - offset) * scale;
    let id = pattern_random(found, pattern_wrapped(columns.number, counts.x), row, params.seed).z;
    return pattern_box(found, low, high, params.joint, params.bevel, id);
}

/// Planks: 1 on them, 0 in the joints.
fn mask(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let cover = pattern_cover(cell, params.joint, at.texel_size);
    return mix(mean_cover(params), cover, seen(at, params));
}

/// The rounded surface of a plank: 0 in the joints, 1 on its face.
fn height(at: Surface, cell: PatternCell, params: Params) -> f32 {
    let height = pattern_height(cell, params.bevel, at.texel_size);
    return mix(mean_cover(params), height, seen(at, params));
}

/// A random value for each plank.
fn id(cell: PatternCell) -> f32 {
    return unit_random(cell.id);
}

/// A slight tilt of each plank: 0.5 in its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the joint: 0 in it, 1 in the middle of a plank.
fn away(at: Surface, cell: PatternCell, params: Params) -> f32 {
    return mix(0.5 * mean_cover(params), pattern_away(cell, params.joint), seen(at, params));
}

/// The place in each plank, for a noise or an image that is another one on each.
/// @vector
fn place(cell: PatternCell) -> vec3f {
    return pattern_vector(cell);
}

/// The place across each plank for an image that fills it: x and y from 0 to 1, to the right and up.
/// @vector
fn uv(cell: PatternCell) -> vec3f {
    return pattern_uv(cell);
}

// The share of planks in the surface.
fn mean_cover(params: Params) -> f32 {
    return max(1.0 - params.joint / params.length, 0.0) * max(1.0 - params.joint / params.width, 0.0);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(2.0 * min(params.length, params.width), at.texel_size);
}
