//! Match
//! Gives a mask the mean and the spread that are asked for, on any model.
//!
//! The values are measured over the whole model, by its true area, and moved and stretched so that after clamping to 0..1
//! they have this mean and this standard deviation, as far as there is such a mask. Flatten also evens out the histogram, as
//! if every value were equally frequent; places keep their order from dark to bright. With Each, every part, piece or chart
//! is measured for itself, up to 1024 of them; of more, several share a measure.
//! @alias histogram equalize normalize standardize mean deviation contrast brightness transfer balance
//! @use survey

struct Params {
    /// Mean of the result over the surface.
    /// @range 0 1 @default 0.5
    mean: f32,
    /// Standard deviation of the result: 0 is even, 0.29 uses all values alike, 0.5 is black and white.
    /// @range 0 0.5 @default 0.2
    spread: f32,
    /// How even the histogram becomes: 0 keeps its shape, 1 makes all values equally frequent.
    /// @range 0 1 @default 0
    flatten: f32,
    /// What is measured apart: nothing, or each part, piece or chart, so that each gets its own share.
    /// @choice whole part piece chart @default whole
    each: u32,
}

/// Values of the mask that are measured.
const SAMPLES: i32 = 32;
/// Steps toward mean and spread.
const ROUNDS: i32 = 24;

// The values below which three successive fourteenths of the surface end, from `first` on.
fn knots(survey: texture_2d_array<f32>, group: u32, first: f32) -> vec3f {
    return vec3f(
        survey_value_of(survey, group, first / 14.0),
        survey_value_of(survey, group, (first + 1.0) / 14.0),
        survey_value_of(survey, group, (first + 2.0) / 14.0),
    );
}

/// The lowest value, and the first two knots.
/// @pass 1 @vector @surveys source params.each
fn darkest(survey: texture_2d_array<f32>, group: u32) -> vec3f {
    return knots(survey, group, 0.0);
}

/// Knots 3 to 5.
/// @pass 2 @vector @surveys source params.each
fn dark(survey: texture_2d_array<f32>, group: u32) -> vec3f {
    return knots(survey, group, 3.0);
}

/// Knots 6 to 8, the middle one among them.
/// @pass 3 @vector @surveys source params.each
fn middle(survey: texture_2d_array<f32>, group: u32) -> vec3f {
    return knots(survey, group, 6.0);
}

/// Knots 9 to 11.
/// @pass 4 @vector @surveys source params.each
fn bright(survey: texture_2d_array<f32>, group: u32) -> vec3f {
    return knots(survey, group, 9.0);
}

/// Knots 12 and 13, and the highest value.
/// @pass 5 @vector @surveys source params.each
fn brightest(survey: texture_2d_array<f32>, group: u32) -> vec3f {
    return knots(survey, group, 12.0);
}

// Part of the way from one knot to the next, three at a time. A value that much of the surface has counts as its lowest.
fn passed(value: f32, begin: vec3f, end: vec3f) -> f32 {
    let part = clamp((value - begin) / max(end - begin, vec3f(1e-9)), vec3f(0.0), vec3f(1.0));
    return part.x + part.y + part.z;
}

// The share of the surface below a value, by straight lines between the knots.
fn share_below(value: f32, a: vec3f, b: vec3f, c: vec3f, d: vec3f, e: vec3f) -> f32 {
    let sum = passed(value, a, vec3f(a.yz, b.x)) + passed(value, b, vec3f(b.yz, c.x))
        + passed(value, c, vec3f(c.yz, d.x)) + passed(value, d, vec3f(d.yz, e.x))
        + passed(value, e, vec3f(e.yz, e.z + 1e9));
    return sum / 14.0;
}

/// Factor, sum and unit that bring the mask to mean and spread: found step by step on values that stand for equal areas.
/// @pass 6 @vector @surveys source params.each
fn fit(survey: texture_2d_array<f32>, group: u32, params: Params) -> vec3f {
    let a = knots(survey, group, 0.0);
    let b = knots(survey, group, 3.0);
    let c = knots(survey, group, 6.0);
    let d = knots(survey, group, 9.0);
    let e = knots(survey, group, 12.0);
    let unit = 1.0 / max(e.z - a.x, 1e-4);
    var values: array<f32, 32>;
    for (var index = 0; index < SAMPLES; index++) {
        let value = survey_value_of(survey, group, (f32(index) + 0.5) / f32(SAMPLES));
        values[index] = mix((value - a.x) * unit, share_below(value, a, b, c, d, e), params.flatten);
    }
    var factor = 1.0;
    var sum = params.mean - 0.5;
    for (var turn = 0; turn < ROUNDS; turn++) {
        var first = 0.0;
        var second = 0.0;
        for (var index = 0; index < SAMPLES; index++) {
            let value = clamp(values[index] * factor + sum, 0.0, 1.0);
            first += value;
            second += value * value;
        }
        let mean = first / f32(SAMPLES);
        let spread = sqrt(max(second / f32(SAMPLES) - mean * mean, 0.0));
        // Stretched around the middle that it has, then moved.
        let stretch = clamp(params.spread / max(spread, 1e-6), 0.25, 4.0);
        let next = clamp(factor * stretch, 1e-4, 100.0);
        sum = mean - (mean - sum) * (next / factor) + (params.mean - mean);
        factor = next;
    }
    return vec3f(factor, sum, unit);
}

/// The mask with that mean and spread.
/// @input source The mask to match.
fn mask(
    params: Params, source: f32,
    darkest: vec3f, dark: vec3f, middle: vec3f, bright: vec3f, brightest: vec3f, fit: vec3f,
) -> f32 {
    let even = share_below(source, darkest, dark, middle, bright, brightest);
    let value = mix((source - darkest.x) * fit.z, even, params.flatten);
    return clamp(value * fit.x + fit.y, 0.0, 1.0);
}
