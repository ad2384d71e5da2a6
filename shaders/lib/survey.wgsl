//! Results of a survey: the distribution of a mask's values over the surface, by true area.
//!
//! A survey is a table of 1024 even steps from the lowest to the highest value, with a row for each group of places that is
//! measured apart. Functions that end on `_of` take the number of a group; those without read the whole surface.

const SURVEY_STEPS: i32 = 1024;

/// Lowest and highest value; a little apart even where all of the surface has one value.
fn survey_range_of(survey: texture_2d_array<f32>, group: u32) -> vec2f {
    let ends = textureLoad(survey, vec2i(0, i32(group)), 0, 0).zw;
    return vec2f(ends.x, max(ends.y, ends.x + 1e-6 * max(1.0, abs(ends.x))));
}

/// Share of the surface below the end of a step, and the integral of that share up to there over the whole range as 1.
fn survey_step_of(survey: texture_2d_array<f32>, group: u32, step: i32) -> vec2f {
    let found = textureLoad(survey, vec2i(clamp(step, 0, SURVEY_STEPS - 1), i32(group)), 0, 0).xy;
    return select(found, vec2f(0.0), step < 0);
}

/// Share of the surface where the mask is below a value.
fn survey_share_below_of(survey: texture_2d_array<f32>, group: u32, value: f32) -> f32 {
    let range = survey_range_of(survey, group);
    let place = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * f32(SURVEY_STEPS);
    let step = i32(place);
    return mix(survey_step_of(survey, group, step - 1).x, survey_step_of(survey, group, step).x, place - f32(step));
}

/// The value that the mask is below on this share of the surface.
fn survey_value_of(survey: texture_2d_array<f32>, group: u32, share: f32) -> f32 {
    var low = -1;
    var high = SURVEY_STEPS - 1;
    for (var index = 0; index < 10; index++) {
        let middle = (low + high) / 2;
        let is_above = survey_step_of(survey, group, middle).x >= share;
        high = select(high, middle, is_above);
        low = select(middle, low, is_above);
    }
    let from_share = survey_step_of(survey, group, high - 1).x;
    let to_share = survey_step_of(survey, group, high).x;
    let part = clamp((share - from_share) / max(to_share - from_share, 1e-9), 0.0, 1.0);
    let range = survey_range_of(survey, group);
    return mix(range.x, range.y, (f32(high) + part) / f32(SURVEY_STEPS));
}

/// Integral of the share below a value, from the lowest value on; the whole range counts as 1.
fn survey_integral_of(survey: texture_2d_array<f32>, group: u32, value: f32) -> f32 {
    let range = survey_range_of(survey, group);
    let along = (value - range.x) / (range.y - range.x);
    let place = clamp(along, 0.0, 1.0) * f32(SURVEY_STEPS);
    let step = min(i32(place), SURVEY_STEPS - 1);
    let part = place - f32(step);
    let before = survey_step_of(survey, group, step - 1);
    let after = survey_step_of(survey, group, step);
    let inside = before.y + part * (before.x + 0.5 * part * (after.x - before.x)) / f32(SURVEY_STEPS);
    return inside + max(along - 1.0, 0.0);
}

/// Middle of the ramp of width `softness` that turns the mask into one whose mean over the surface is `amount`.
fn survey_threshold_of(survey: texture_2d_array<f32>, group: u32, amount: f32, softness: f32) -> f32 {
    let range = survey_range_of(survey, group);
    let span = range.y - range.x;
    let half = 0.5 * max(softness, span / 4096.0);
    var low = range.x - half;
    var high = range.y + half;
    for (var index = 0; index < 24; index++) {
        let middle = 0.5 * (low + high);
        let below = survey_integral_of(survey, group, middle + half) - survey_integral_of(survey, group, middle - half);
        let covered = 1.0 - below * span / (2.0 * half);
        let is_too_much = covered > amount;
        low = select(low, middle, is_too_much);
        high = select(middle, high, is_too_much);
    }
    return high;
}

/// The value that the mask is below on this share of the surface.
fn survey_value(survey: texture_2d_array<f32>, share: f32) -> f32 {
    return survey_value_of(survey, 0u, share);
}

/// Share of the surface where the mask is below a value.
fn survey_share_below(survey: texture_2d_array<f32>, value: f32) -> f32 {
    return survey_share_below_of(survey, 0u, value);
}

/// Middle of the ramp of width `softness` that turns the mask into one whose mean over the surface is `amount`.
fn survey_threshold(survey: texture_2d_array<f32>, amount: f32, softness: f32) -> f32 {
    return survey_threshold_of(survey, 0u, amount, softness);
}
