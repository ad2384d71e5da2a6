//! Stripes
//! Parallel bands on every side of the model and around its corners: hazard marks, corrugated sheet, tool marks.
//!
//! Bands narrower than the texels fade to their mean.
//! @alias lines bands hazard zebra corrugated louver ribs groove barcode
//! @use pattern

struct Params {
    /// Distance from one stripe to the next.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Width of a stripe as a share of the distance.
    /// @range 0 1 @default 0.5
    width: f32,
    /// Softness of the borders, as a share of the distance.
    /// @range 0 1 @default 0
    softness: f32,
    /// Irregularity: how much stripes differ in width.
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

/// The stripe of a place.
/// @shared
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn stripe(at: Surface, position: vec3f, params: Params) -> Stripe {
    let found = pattern_place(at, position, params.space, params.rotate, vec2f(params.size));
    let key = pattern_key(found, params.seed);
    let count = pattern_counts(found, vec2f(params.size)).y;
    // A stripe reaches from the middle of its cell to both sides, so that it is whole within the cell.
    let span = pattern_span(found.place.y / params.size + 0.137, params.uneven, key, count);
    let scale = params.size / found.speed.y;
    let middle = (found.place.y / params.size + 0.137 - 0.5 * (span.low + span.high)) * scale;
    let half = 0.5 * params.width * (span.high - span.low) * scale;
    let id = pcg3d(vec3u(bitcast<u32>(pattern_wrapped(span.number, count)), 0x5bd1e995u, 3u) + key).y;
    let section = params.size / found.speed.x;
    let along = (fract(found.place.x / params.size + 0.237) - 0.5) * section;
    let whole = vec2f(section, (span.high - span.low) * scale);
    let cell = PatternCell(vec2f(along, middle), 0.5 * whole, half - abs(middle), id, found.hand);
    return Stripe(cell, half, along_of(found.place.x, found.period.x) / found.speed.x, at.texel_size);
}

/// Stripes: 1 on them, 0 between.
fn mask(at: Surface, stripe: Stripe, params: Params) -> f32 {
    let ramp = max(params.softness * params.size, stripe.texel);
    return mix(params.width, clamp(stripe.cell.inside / max(ramp, 1e-9) + 0.5, 0.0, 1.0), seen(at, params));
}

/// A round ridge for each stripe: 0 between, 1 along its middle.
fn height(at: Surface, stripe: Stripe, params: Params) -> f32 {
    let q = clamp(1.0 - stripe.cell.inside / max(stripe.half, 1e-9), 0.0, 1.0);
    return mix(0.78539816 * params.width, sqrt(max(1.0 - q * q, 0.0)), seen(at, params));
}

/// A random value for each stripe, the gap above it included.
fn id(stripe: Stripe) -> f32 {
    return unit_random(stripe.cell.id);
}

/// A slight tilt of each stripe: 0.5 along its middle, more on one side and less on the other. Add it to the height.
fn tilt(at: Surface, stripe: Stripe, params: Params) -> f32 {
    var cell = stripe.cell;
    // A stripe has no ends, so it is tilted across only.
    cell.middle.x = 0.0;
    return mix(0.5, pattern_tilt(cell), seen(at, params));
}

/// Distance to the border: 0 on it and between stripes, 1 along the middle of a stripe.
fn away(at: Surface, stripe: Stripe, params: Params) -> f32 {
    return mix(0.5 * params.width, clamp(stripe.cell.inside / max(stripe.half, 1e-9), 0.0, 1.0), seen(at, params));
}

/// The place in each stripe, for a noise that is another one in each: x along it without an end, y from its middle. Stripes
/// that close up around a piece go in a circle, so that noises close up too.
/// @vector
fn place(stripe: Stripe) -> vec3f {
    let cell = PatternCell(
        vec2f(stripe.along.x, stripe.cell.middle.y), stripe.cell.half, stripe.cell.inside, stripe.cell.id, stripe.cell.hand,
    );
    return pattern_vector(cell) + vec3f(0.0, 0.0, stripe.along.y);
}

/// The place across each stripe for an image that is repeated along it: x and y from 0 to 1, to the right and up. An image is as
/// long as Size, and as high as a stripe with half the gaps beside it.
/// @vector
fn uv(stripe: Stripe) -> vec3f {
    return pattern_uv(stripe.cell);
}

struct Stripe {
    // A part of the stripe, as long as Size, with half the gaps beside it.
    cell: PatternCell,
    // Half the width of the stripe, and how far along it the place lies, in the plane and before it; working units.
    half: f32,
    along: vec2f,
    texel: f32,
}

// A place along a stripe: in the plane, or on a circle as long as a whole turn.
fn along_of(x: f32, turn: f32) -> vec2f {
    let radius = max(turn, 1e-9) / 6.2831853;
    return select(vec2f(x, 0.0), radius * vec2f(sin(x / radius), 1.0 - cos(x / radius)), turn > 0.0);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(params.size, at.texel_size);
}
