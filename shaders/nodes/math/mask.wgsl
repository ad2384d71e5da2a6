//! Mask math
//! Calculates with masks: sums, products, powers, waves and comparisons.
//!
//! Results are not clamped to 0 to 1; use Clamp or Levels to bring them back. What has no result in numbers, such as a
//! division by 0, gives 0.
//! @alias math add subtract multiply divide power sine cosine modulo fraction absolute compare smoothstep arithmetic function expression
//! @use noise

struct Params {
    /// What is calculated. A alone is used from absolute to cosine; C only by mix, smoothstep and wrap.
    /// Power takes A without its sign.
    /// @choice add subtract multiply divide power min max modulo greater mix smoothstep wrap absolute negate sign floor round fraction square_root sine cosine
    /// @default multiply
    operation: u32,
}

/// The result.
/// @input a The first value; an angle in turns for sine and cosine. @optional @default 0
/// @input b The second value. @optional @default 1
/// @input c The third value: the weight of B in a mix, the lower end of smoothstep and wrap, whose upper end is B. @optional @default 0.5
fn mask(a: f32, b: f32, c: f32, params: Params) -> f32 {
    return clamp(calculated(a, b, c, params.operation), -60000.0, 60000.0);
}

fn calculated(a: f32, b: f32, c: f32, operation: u32) -> f32 {
    switch operation {
        case 0u: { return a + b; }
        case 1u: { return a - b; }
        case 2u: { return a * b; }
        case 3u: { return quotient(a, b); }
        case 4u: { return power(a, b); }
        case 5u: { return min(a, b); }
        case 6u: { return max(a, b); }
        case 7u: { return select(0.0, a - b * floor(quotient(a, b)), abs(b) > 1e-20); }
        case 8u: { return select(0.0, 1.0, a > b); }
        case 9u: { return mix(a, b, c); }
        case 10u: {
            if abs(b - c) <= 1e-20 {
                return select(0.0, 1.0, a >= b);
            }
            let t = clamp((a - c) / (b - c), 0.0, 1.0);
            return t * t * (3.0 - 2.0 * t);
        }
        case 11u: { return select(c, a - (b - c) * floor(quotient(a - c, b - c)), abs(b - c) > 1e-20); }
        case 12u: { return abs(a); }
        case 13u: { return -a; }
        case 14u: { return sign(a); }
        case 15u: { return floor(a); }
        case 16u: { return floor(a + 0.5); }
        case 17u: { return a - floor(a); }
        case 18u: { return sqrt(max(a, 0.0)); }
        case 19u: { return wave(a).x; }
        default: { return wave(a).y; }
    }
}

fn quotient(a: f32, b: f32) -> f32 {
    return select(0.0, a / b, abs(b) > 1e-20);
}

fn power(a: f32, b: f32) -> f32 {
    let base = abs(a);
    return select(select(0.0, 1.0, b == 0.0), exp2(clamp(b * log2(max(base, 1e-30)), -126.0, 126.0)), base > 1e-30);
}

// Sine and cosine of an angle in turns, which is reduced first: large angles have no precision left otherwise.
fn wave(turns: f32) -> vec2f {
    let turn = turn_of(vec3f(6.2831853 * (turns - floor(turns)), 0.0, 0.0));
    return vec2f(turn.sine.x, turn.cosine.x);
}
