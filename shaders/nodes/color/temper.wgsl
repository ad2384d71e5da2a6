//! Temper colors
//! Heat tint of bare metal: straw, brown, purple and blue around welds, exhausts and burned edges.
//!
//! Heat grows a clear film of oxide on the metal, whose thickness decides which wavelengths cancel out. Use the color for the
//! base color of a metal, and the mask to put it over another material.
//! @alias temper heat tint weld blue anodize exhaust oxide thin film interference rainbow burn bluing annealing titanium
//! @use core noise

struct Params {
    /// Metal under the film. Steel turns straw, brown, purple, blue and gray; titanium goes on through pale gold, pink and
    /// green.
    /// @choice steel titanium @default steel
    metal: u32,
    /// Temperature where Heat is 0, degrees Celsius.
    /// @range 0 1000 @default 150
    low: f32,
    /// Temperature where Heat is 1, degrees Celsius. Steel is straw at 220, brown at 255, purple at 280, blue at 300 and gray
    /// from 370 on.
    /// @range 0 1000 @default 390
    high: f32,
    /// How pure the colors are: 1 is a polished surface, less is rough or scaled metal.
    /// @range 0 1 @default 0.85
    purity: f32,
    /// Share of dull gray scale that covers the film above the last color.
    /// @range 0 1 @default 0.85
    scale: f32,
}

/// Color of the heated metal, in linear light.
/// @input heat How hot each place became, 0 to 1 from Low to High. @optional @default 0.5
fn color(heat: f32, params: Params) -> vec3f {
    let temperature = mix(params.low, params.high, clamp(heat, 0.0, 1.0));
    let film = film_of(temperature, params.metal);
    let tint = film_color(film, params.metal);
    let shown = mix(vec3f(luminance(tint)), tint, params.purity);
    let scaled = smoothstep(0.0, 130.0, temperature - select(350.0, 650.0, params.metal == 1u));
    return mix(shown, vec3f(0.13, 0.135, 0.15), scaled * params.scale);
}

/// 1 where the film has a color, 0 where the metal is still bright.
fn mask(heat: f32, params: Params) -> f32 {
    let film = film_of(mix(params.low, params.high, clamp(heat, 0.0, 1.0)), params.metal);
    return smoothstep(4.0, 28.0, film);
}

// Thickness of the oxide after a short heating, nanometers. It grows by the square root of time, with a rate after
// Arrhenius (Wagner's parabolic law, 1933); the two numbers put the colors where tables of temper colors have them.
fn film_of(celsius: f32, metal: u32) -> f32 {
    let inverse = 1.0 / (max(celsius, 0.0) + 273.15);
    let steel = 46.0 * exp(2650.0 * (1.0 / 573.15 - inverse));
    let titanium = 45.0 * exp(4535.0 * (1.0 / 753.15 - inverse));
    return min(select(steel, titanium, metal == 1u), 240.0);
}

// Color of a film in linear light: light that is reflected at the film and at the metal below it, added as waves (Airy's
// sum, see Born and Wolf, "Principles of Optics", 7.6 and 14.4), at normal incidence.
//
// Twelve wavelengths, in nanometers, are within 0.001 of the color of a hundred for steel, and within 0.015 for titanium.
// For each of them: its linear Rec. 709 color, all together white (CIE 1931 by the fits of Wyman, Sloan and Shirley,
// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", 2013, adapted to D65); then refractive index
// and absorption of the oxide and of the metal, rounded, for iron and for titanium (Johnson and Christy, "Optical constants
// of transition metals", 1974; iron oxide between magnetite and hematite). Written out: software adapters are slow at
// reading arrays.
fn film_color(film: f32, metal: u32) -> vec3f {
    let is_steel = metal == 0u;
    var sum = vec3f(0.0);
    sum += vec3f(0.00883, -0.00730, 0.05506)
        * reflectance(film / 410.0, select(vec4f(2.664, 0, 1.643, 2.186), vec4f(2.6, 0.4514, 2.271, 2.607), is_steel));
    sum += vec3f(0.02549, -0.04747, 0.44100)
        * reflectance(film / 435.0, select(vec4f(2.593, 0, 1.679, 2.257), vec4f(2.6, 0.3693, 2.414, 2.696), is_steel));
    sum += vec3f(-0.02729, -0.01853, 0.44562)
        * reflectance(film / 460.0, select(vec4f(2.537, 0, 1.72, 2.33), vec4f(2.59, 0.29, 2.545, 2.768), is_steel));
    sum += vec3f(-0.09427, 0.06870, 0.15618)
        * reflectance(film / 485.0, select(vec4f(2.504, 0, 1.77, 2.405), vec4f(2.565, 0.215, 2.658, 2.813), is_steel));
    sum += vec3f(-0.18792, 0.21800, 0.01780)
        * reflectance(film / 510.0, select(vec4f(2.472, 0, 1.82, 2.48), vec4f(2.54, 0.16, 2.77, 2.858), is_steel));
    sum += vec3f(-0.17734, 0.35638, -0.03320)
        * reflectance(film / 535.0, select(vec4f(2.439, 0, 1.87, 2.555), vec4f(2.515, 0.135, 2.883, 2.903), is_steel));
    sum += vec3f(0.07733, 0.30549, -0.03894)
        * reflectance(film / 560.0, select(vec4f(2.414, 0, 1.93, 2.63), vec4f(2.49, 0.116, 2.945, 2.942), is_steel));
    sum += vec3f(0.40953, 0.14970, -0.02702)
        * reflectance(film / 585.0, select(vec4f(2.399, 0, 2.005, 2.705), vec4f(2.465, 0.106, 2.933, 2.972), is_steel));
    sum += vec3f(0.54084, 0.00424, -0.01151)
        * reflectance(film / 610.0, select(vec4f(2.384, 0, 2.08, 2.78), vec4f(2.44, 0.096, 2.92, 3.002), is_steel));
    sum += vec3f(0.32082, -0.02405, -0.00350)
        * reflectance(film / 635.0, select(vec4f(2.369, 0, 2.155, 2.855), vec4f(2.415, 0.086, 2.907, 3.032), is_steel));
    sum += vec3f(0.09155, -0.00582, -0.00113)
        * reflectance(film / 660.0, select(vec4f(2.357, 0, 2.236, 2.927), vec4f(2.395, 0.07727, 2.9, 3.073), is_steel));
    sum += vec3f(0.01245, 0.00071, -0.00034)
        * reflectance(film / 685.0, select(vec4f(2.35, 0, 2.327, 2.995), vec4f(2.384, 0.07045, 2.9, 3.13), is_steel));
    return max(sum, vec3f(0.0));
}

// Share of light that is reflected; thickness in wavelengths, indices of oxide and metal as complex numbers.
fn reflectance(thickness: f32, indices: vec4f) -> f32 {
    let oxide = indices.xy;
    let above = divided(vec2f(1.0, 0.0) - oxide, vec2f(1.0, 0.0) + oxide);
    let below = divided(oxide - indices.zw, oxide + indices.zw);
    // Change of the wave on its way through the film and back.
    let turn = turn_of(vec3f(12.566371 * oxide.x * thickness));
    let passed = vec2f(turn.cosine.x, turn.sine.x) * exp(-12.566371 * oxide.y * thickness);
    let inner = times(below, passed);
    let wave = divided(above + inner, vec2f(1.0, 0.0) + times(above, inner));
    return dot(wave, wave);
}

fn times(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

fn divided(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / max(dot(b, b), 1e-12);
}
