//! Position gradient
//! A ramp over the model along one direction, such as from the ground to the top.
//!
//! 0 and 1 of Low and High are the ends of the model, whatever its size, so the ramp fits any model.
//! @alias position height ramp gradient ground bottom top altitude coordinate

struct Params {
    /// Direction of the ramp, in model space.
    /// @range -1 1 @default 0 1 0
    along: vec3f,
    /// Position at which the ramp is 0, as a share of the model's extent.
    /// @range -10 10 @soft 0 1 @default 0
    low: f32,
    /// Position at which the ramp is 1, as a share of the model's extent. If it is below Low, the ramp is reversed.
    /// @range -10 10 @soft 0 1 @default 1
    high: f32,
    /// Where the model begins along the direction.
    /// @extent low along
    extent_low: f32,
    /// Where the model ends along the direction.
    /// @extent high along
    extent_high: f32,
}

/// The ramp, 0 to 1.
fn mask(at: Surface, params: Params) -> f32 {
    let along = params.along * inverseSqrt(max(dot(params.along, params.along), 1e-20));
    let extent = max(params.extent_high - params.extent_low, 1e-9);
    let share = (dot(at.position, along) - params.extent_low) / extent;
    let length = params.high - params.low;
    // A ramp without length is a step, not a division by zero.
    return clamp((share - params.low) / select(length, 1e-6, abs(length) < 1e-6), 0.0, 1.0);
}

/// The position of each place, to warp noises with.
/// @vector
fn position(at: Surface) -> vec3f {
    return at.position;
}
