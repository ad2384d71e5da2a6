//! From light to a picture: exposure, view transform, samples brought together, sRGB.
//! @use view/cover view/srgb view/bright

struct DisplayUniforms {
    // Display-referred linear color of the background; transparent where w is 0.
    backdrop: vec4f,
    // Factor of the light, applied first.
    exposure: f32,
    // Number of samples in the sum, including this one.
    samples: f32,
    // Share of the light above white that spreads.
    bloom: f32,
    pad: f32,
}

// View transforms; the last is for pictures that are encoded already.
const STANDARD: u32 = 0u;
const AGX: u32 = 1u;
const ACES: u32 = 2u;
const ENCODED: u32 = 3u;
const NEUTRAL: u32 = 4u;
const AGX_PUNCHY: u32 = 5u;

// View transform of the pipeline; see `switches.wgsl` for why it is no uniform.
override TRANSFORM: u32 = STANDARD;
// 1 where light above white spreads.
override BLOOM: u32 = 0u;

@group(0) @binding(0) var<uniform> display: DisplayUniforms;
@group(0) @binding(1) var light: texture_2d<f32>;
// The sum of the samples before this one, display-referred and linear, alpha premultiplied.
@group(0) @binding(2) var earlier: texture_2d<f32>;
// The light above white, exposed and spread, at a part of the picture's size; see `bloom.wgsl`.
@group(0) @binding(3) var spread: texture_2d<f32>;
@group(0) @binding(4) var between: sampler;

// AgX by T. Sobotka: light is brought into a wider gamut, its logarithm runs through a curve, and comes back less saturated.
// Matrices and the curve's polynomial: B. Wrensch 2023, "Minimal AgX implementation", and the Rec. 2020 matrices of Blender 4's
// configuration.
fn agx(color: vec3f, power: f32, saturation: f32) -> vec3f {
    let wide_from_rec709 = mat3x3f(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0113, 0.8956);
    let rec709_from_wide = mat3x3f(1.6605, -0.1246, -0.0182, -0.5876, 1.1329, -0.1006, -0.0728, -0.0083, 1.1187);
    let inset = mat3x3f(
        0.856627153315983, 0.137318972929847, 0.11189821299995,
        0.0951212405381588, 0.761241990602591, 0.0767994186031903,
        0.0482516061458583, 0.101439036467562, 0.811302368396859,
    );
    let outset = mat3x3f(
        1.1271005818144368, -0.1413297634984383, -0.14132976349843826,
        -0.11060664309660323, 1.157823702216272, -0.11060664309660294,
        -0.016493938717834573, -0.016493938717834257, 1.2519364065950405,
    );
    // Stops below and above middle gray that the curve spans, as exponents of two.
    let lowest = -12.47393;
    let highest = 4.026069;
    let inside = inset * (wide_from_rec709 * color);
    let stops = clamp(log2(max(inside, vec3f(1e-10))), vec3f(lowest), vec3f(highest));
    let x = (stops - lowest) / (highest - lowest);
    let x2 = x * x;
    let x4 = x2 * x2;
    let curve = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    // The look, in the space of the curve: contrast, and saturation about luminance.
    let contrasted = pow(max(curve, vec3f(0.0)), vec3f(power));
    let gray = dot(contrasted, vec3f(0.2126, 0.7152, 0.0722));
    let out = outset * (gray + saturation * (contrasted - gray));
    return clamp(rec709_from_wide * pow(max(out, vec3f(0.0)), vec3f(2.2)), vec3f(0.0), vec3f(1.0));
}

// The PBR Neutral tone mapper (Khronos Group 2024): colors keep their values up to 0.8 but for the reflection of a dielectric
// that is taken off, and brighter ones approach white.
fn neutral(light: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let lowest = min(light.x, min(light.y, light.z));
    let color = light - select(0.04, lowest - 6.25 * lowest * lowest, lowest < 0.08);
    let peak = max(color.x, max(color.y, color.z));
    if peak < start {
        return color;
    }
    let room = 1.0 - start;
    let lowered = 1.0 - room * room / (peak + room - start);
    let toward_white = 1.0 - 1.0 / (0.15 * (peak - lowered) + 1.0);
    return mix(color * (lowered / peak), vec3f(lowered), toward_white);
}

// The fit of the ACES reference rendering and sRGB output transforms by S. Hill 2017 (BakingLab).
fn aces(color: vec3f) -> vec3f {
    let into = mat3x3f(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    let out_of = mat3x3f(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    let v = into * color;
    let curve = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(out_of * curve, vec3f(0.0), vec3f(1.0));
}

// This sample, display-referred and linear, over the background.
fn shown_at(pixel: vec2i) -> vec4f {
    let seen = textureLoad(light, pixel, 0);
    var color = seen.xyz * display.exposure;
    var glow = vec3f(0.0);
    if BLOOM == 1u {
        // A share of what is above white leaves its pixel, and what arrives from others is added.
        let size = vec2f(textureDimensions(light));
        glow = textureSampleLevel(spread, between, (vec2f(pixel) + 0.5) / size, 0.0).xyz * display.bloom;
        color += glow - above_white(max(color, vec3f(0.0))) * display.bloom;
    }
    switch TRANSFORM {
        case STANDARD: { color = clamp(color, vec3f(0.0), vec3f(1.0)); }
        case NEUTRAL: { color = clamp(neutral(max(color, vec3f(0.0))), vec3f(0.0), vec3f(1.0)); }
        case AGX: { color = agx(color, 1.0, 1.0); }
        case AGX_PUNCHY: { color = agx(color, 1.35, 1.4); }
        case ACES: { color = aces(color); }
        default: { color = linear_of(clamp(seen.xyz, vec3f(0.0), vec3f(1.0))); }
    }
    // A plain background is display-referred, and the glow before it is added as it is; a clear one stays clear.
    let behind = vec4f(min(display.backdrop.xyz + glow, vec3f(1.0)), 1.0) * display.backdrop.w;
    return vec4f(color, 1.0) * seen.w + behind * (1.0 - seen.w);
}

@fragment
fn gather(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(earlier, vec2i(at.xy), 0) + shown_at(vec2i(at.xy));
}

@fragment
fn encode(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return encoded_mean(shown_at(vec2i(at.xy)));
}

@fragment
fn encode_sum(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return encoded_mean(textureLoad(earlier, vec2i(at.xy), 0));
}

fn encoded_mean(sum: vec4f) -> vec4f {
    return vec4f(code_of(sum.xyz / max(sum.w, 1e-6)), sum.w / display.samples);
}
