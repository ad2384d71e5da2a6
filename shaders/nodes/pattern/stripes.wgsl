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

/// Stripes: 1 on them, 0 between.
/// @input position Where the pattern is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    let stripe = stripe_at(at, position, params);
    let ramp = max(params.softness * params.size, stripe.texel);
    return mix(params.width, clamp(stripe.inside / max(ramp, 1e-9) + 0.5, 0.0, 1.0), seen(at, params));
}

/// A round ridge for each stripe: 0 between, 1 along its middle.
fn height(at: Surface, position: vec3f, params: Params) -> f32 {
    let stripe = stripe_at(at, position, params);
    let q = clamp(1.0 - stripe.inside / max(stripe.half, 1e-9), 0.0, 1.0);
    return mix(0.78539816 * params.width, sqrt(max(1.0 - q * q, 0.0)), seen(at, params));
}

/// A random value for each stripe, the gap above it included.
fn id(at: Surface, position: vec3f, params: Params) -> f32 {
    return unit_random(stripe_at(at, position, params).id);
}

struct Stripe {
    // From the border of the stripe inward, and half its width; working units.
    inside: f32,
    half: f32,
    id: u32,
    texel: f32,
}

fn stripe_at(at: Surface, position: vec3f, params: Params) -> Stripe {
    let found = pattern_place(at, position, params.space, params.rotate, vec2f(params.size));
    let key = pattern_key(found, params.seed);
    let count = pattern_counts(found, vec2f(params.size)).y;
    // A stripe reaches from the middle of its cell to both sides, so that it is whole within the cell.
    let span = pattern_span(found.place.y / params.size + 0.137, params.uneven, key, count);
    let scale = params.size / found.speed.y;
    let middle = (found.place.y / params.size + 0.137 - 0.5 * (span.low + span.high)) * scale;
    let half = 0.5 * params.width * (span.high - span.low) * scale;
    let id = pcg3d(vec3u(bitcast<u32>(pattern_wrapped(span.number, count)), 0x5bd1e995u, 3u) + key).y;
    return Stripe(half - abs(middle), half, id, at.texel_size);
}

fn seen(at: Surface, params: Params) -> f32 {
    return carried(params.size, at.texel_size);
}
