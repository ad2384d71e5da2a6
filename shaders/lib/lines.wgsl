//! Lines of true width: the share of a texel that they cover, however thin they are.
//!
//! Each function takes the distance to the middle of a straight line and gives the mean of the line's profile over a texel.
//! So a line thinner than a texel is a faint one and never a row of dots.

/// How wide a square texel is across a line: the wider and the narrower of its two sides as they lie across it. `across`
/// points over the line, `texel_step` along a side of the texel.
fn line_texel(across: vec3f, texel_step: vec3f, texel_size: f32) -> vec2f {
    let lengths = dot(across, across) * dot(texel_step, texel_step);
    let cosine = min(abs(dot(across, texel_step)) * inverseSqrt(max(lengths, 1e-30)), 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    return texel_size * vec2f(max(cosine, sine), min(cosine, sine));
}

/// A line that is whole up to `inner` from its middle and fades out evenly until `outer`.
fn line_cover(distance: f32, inner: f32, outer: f32, texel: vec2f) -> f32 {
    let window = line_window(outer, texel.x);
    let ends = line_ends(distance, window, texel.y);
    let away = min(abs(ends), vec4f(outer));
    let fading = max(away - inner, vec4f(0.0));
    return clamp(line_mean(sign(ends) * (away - 0.5 * fading * fading / max(outer - inner, 1e-12)), window), 0.0, 1.0);
}

/// A rounded groove as wide as twice `outer`: -1 along its middle, 0 beside it.
fn groove_height(distance: f32, outer: f32, texel: vec2f) -> f32 {
    // The profile is -(1 - x²)².
    let window = line_window(outer, texel.x);
    let x = clamp(line_ends(distance, window, texel.y) / max(outer, 1e-12), vec4f(-1.0), vec4f(1.0));
    let square = x * x;
    return clamp(-line_mean(x * (1.0 + square * (-0.66666667 + square * 0.2)) * outer, window), -1.0, 0.0);
}

/// A groove as wide as twice `half`, -1 along its middle, with the ridges that were pushed out of it beside it: 0.25
/// high, each half as wide as the groove.
fn ridged_height(distance: f32, half: f32, texel: vec2f) -> f32 {
    // The profile is -(1 - x²)² (1 - 4 x²) up to x = 1, twice as far as the groove's border.
    let outer = 2.0 * half;
    let window = line_window(outer, texel.x);
    let x = clamp(line_ends(distance, window, texel.y) / max(outer, 1e-12), vec4f(-1.0), vec4f(1.0));
    let square = x * x;
    let area = x * (1.0 + square * (-2.0 + square * (1.8 - square * 0.57142857))) * outer;
    return clamp(-line_mean(area, window), -1.0, 0.25);
}

/// The width that a profile is averaged over: the texel's, and enough of the line's own to be told from rounding.
fn line_window(outer: f32, texel_size: f32) -> f32 {
    return max(texel_size, 2e-3 * outer + 1e-9);
}

/// The ends of two such windows, placed so that their mean stands for one that is moved over the texel's narrower side
/// (Gauss' rule of two points).
fn line_ends(distance: f32, window: f32, narrower: f32) -> vec4f {
    let moved = distance + vec2f(-0.28867513, 0.28867513) * narrower;
    return vec4f(moved + 0.5 * window, moved - 0.5 * window);
}

/// The mean over both windows, of the areas up to their ends.
fn line_mean(area: vec4f, window: f32) -> f32 {
    return 0.5 * (area.x + area.y - area.z - area.w) / window;
}
