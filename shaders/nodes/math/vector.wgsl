//! Vector math
//! Calculates with vectors: positions, directions and the slopes of normal maps.
//!
//! Slopes, as Split material and Image give them, are added to put one normal map over another.
//! @alias vector math add slope normal combine detail cross dot length normalize project rotate scale reorient transform mapping turn
//! @use noise

struct Params {
    /// What is calculated. Project lays A flat on the surface, Project on B keeps the part of A along B, and Rotate turns A
    /// about B by Factor times Angle, or not at all where B is 0.
    /// @choice add subtract multiply scale mix min max cross normalize project project_on_b rotate
    /// @default add
    operation: u32,
    /// Angle of Rotate where Factor is 1; only for Rotate.
    /// @angle @range -360 360 @soft -180 180 @default 90
    angle: f32,
}

/// The result.
/// @vector
/// @input a The first vector. @vector @optional @default 0 0 0
/// @input b The second vector. @vector @optional @default 0 0 0
/// @input factor Factor of Scale, weight of B in Mix, share of Angle in Rotate. @optional @default 1
fn vector(at: Surface, a: vec3f, b: vec3f, factor: f32, params: Params) -> vec3f {
    return clamp(calculated(at, a, b, factor, params), vec3f(-60000.0), vec3f(60000.0));
}

/// Length of the result.
fn length_of(at: Surface, a: vec3f, b: vec3f, factor: f32, params: Params) -> f32 {
    return length(vector(at, a, b, factor, params));
}

/// Dot product of A and B: for directions of unit length the cosine of the angle between them.
fn dot_product(a: vec3f, b: vec3f) -> f32 {
    return clamp(dot(a, b), -60000.0, 60000.0);
}

fn calculated(at: Surface, a: vec3f, b: vec3f, factor: f32, params: Params) -> vec3f {
    switch params.operation {
        case 0u: { return a + b; }
        case 1u: { return a - b; }
        case 2u: { return a * b; }
        case 3u: { return a * factor; }
        case 4u: { return mix(a, b, factor); }
        case 5u: { return min(a, b); }
        case 6u: { return max(a, b); }
        case 7u: { return cross(a, b); }
        case 8u: { return unit_of(a); }
        case 9u: { return a - at.normal * dot(a, at.normal); }
        case 10u: { return unit_of(b) * dot(a, unit_of(b)); }
        default: {
            // Rodrigues' rotation formula.
            let axis = unit_of(b);
            if dot(axis, axis) < 0.5 {
                return a;
            }
            let turns = factor * params.angle / 6.2831853;
            let turn = turn_of(vec3f(6.2831853 * (turns - floor(turns)), 0.0, 0.0));
            let rest = axis * dot(a, axis) * (1.0 - turn.cosine.x);
            return a * turn.cosine.x + cross(axis, a) * turn.sine.x + rest;
        }
    }
}

// The vector of length 0 has no direction and stays what it is.
fn unit_of(v: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(vec3f(0.0), v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}
