//! Bloom: the light above white, spread over the picture as a lens spreads it. It is gathered at a quarter of the picture's size,
//! halved level by level, and brought together from the coarsest level to the finest, each with the same share of the light.
//! @use view/cover view/bright

struct BloomPass {
    // Factor of the light, applied first.
    exposure: f32,
    // Share of the coarser level in the mix of two.
    coarser_share: f32,
    pad_0: f32,
    pad_1: f32,
}

@group(0) @binding(0) var<uniform> bloom_pass: BloomPass;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(2) var coarser: texture_2d<f32>;
@group(0) @binding(3) var between: sampler;

// The mean of 4 × 4 pixels, in steps of 2 × 2, so that a single pixel that sparkles counts little.
@fragment
fn gather_bright(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(source));
    var sum = vec3f();
    for (var i = 0u; i < 4u; i++) {
        let corner = (floor(at.xy) * 4.0 + 1.0 + 2.0 * vec2f(vec2u(i % 2u, i / 2u))) / size;
        let seen = textureSampleLevel(source, between, corner, 0.0);
        sum += above_white(max(seen.xyz, vec3f()) * bloom_pass.exposure) * seen.w;
    }
    return vec4f(sum * 0.25, 1.0);
}

// A level of half the size: 16 texels with the weights 1 3 3 1 along both sides.
@fragment
fn halve(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return around(source, floor(at.xy) * 2.0 + 1.0, 0.75);
}

// A level mixed with the coarser ones.
@fragment
fn mix_levels(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let own = textureLoad(source, vec2i(at.xy), 0);
    return mix(own, around(coarser, at.xy * 0.5, 0.5), bloom_pass.coarser_share);
}

// The mean of four places around one, all in texels.
fn around(picture: texture_2d<f32>, middle: vec2f, offset: f32) -> vec4f {
    let size = vec2f(textureDimensions(picture));
    var sum = vec4f();
    for (var i = 0u; i < 4u; i++) {
        let side = 2.0 * vec2f(vec2u(i % 2u, i / 2u)) - 1.0;
        sum += textureSampleLevel(picture, between, (middle + offset * side) / size, 0.0);
    }
    return sum * 0.25;
}
