//! Clouds
//! Cloudy noise with detail of many sizes, the base of most natural wear.
//!
//! Fractal simplex noise: octaves of ever finer noise on top of each other. The result is a mask whose threshold is the
//! covered share: a threshold at 0.3 leaves about 30 % of the surface below it. Detail finer than the texels fades out
//! evenly, so a small map looks like a large one from afar.
//! @alias clouds perlin fbm fractal billow ridged turbulence simplex grunge dirt musgrave
//! @use noise

struct Params {
    /// Size of the largest clouds.
    /// @length @range 0.0001 100 @soft 0.02 1 @default 0.25
    size: f32,
    /// Number of finer layers of noise.
    /// @label Detail @range 1 16 @soft 1 10 @default 8
    octaves: u32,
    /// Factor by which each layer is finer than the one before.
    /// @label Detail step @range 1 4 @soft 1.5 3 @default 2
    lacunarity: f32,
    /// Strength of each layer relative to the one before.
    /// @label Grain @range 0 1 @default 0.5
    gain: f32,
    /// Shape of the clouds: soft (fbm), puffs with creases between them (billow), or sharp ridges (ridged).
    /// @choice fbm billow ridged @default fbm
    mode: u32,
    /// Stretches the pattern along its axes.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The clouds, spread evenly over 0 to 1.
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    var key = seed_key(params.seed);
    // Turned off the model's axes, along which the lattice would show on flat sides, and moved by an offset of its own
    // for each seed, since all simplex noises are zero at the origin.
    var place = finer(noise_place(position, params.stretch, params.rotate) / params.size, 1.0);
    place += unit_random3(pcg3d(key));
    var wavelength = params.size * finest_stretch(params.stretch);
    var weight = 1.0;
    var sum = 0.0;
    var detail = 1.0;
    // Sums of the squared weights, of those that the texels carry, and of the fourth powers.
    var whole = 0.0;
    var kept = 0.0;
    var peaked = 0.0;
    for (var i = 0u; i < params.octaves; i++) {
        let seen = weight * carried(wavelength, at.texel_size);
        let noise = simplex_noise(place, key);
        let crease = crease_of(noise);
        let creased = select(-crease, crease * detail, params.mode == 2u);
        sum += seen * select(creased, noise, params.mode == 0u);
        detail = ridge_detail(crease);
        let square = weight * weight;
        whole += square;
        kept += seen * seen;
        peaked += square * square;
        weight *= params.gain;
        wavelength /= params.lacunarity;
        key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
        place = finer(place, params.lacunarity);
    }
    // What the texels do not carry is averaged out: the mean of normal_share(a + b) over a normal b of variance v is
    // normal_share(a / sqrt(1 + v)).
    let deviation = sum / sqrt(2.0 * whole - kept);
    return evened(deviation, peaked / (whole * whole), params.mode);
}

// The place for the next octave: turned, so that the lattices of two octaves never line up, and moved.
fn finer(place: vec3f, step: f32) -> vec3f {
    let turned = vec3f(
        0.8 * place.y + 0.6 * place.z,
        0.36 * place.y - 0.8 * place.x - 0.48 * place.z,
        0.64 * place.z - 0.6 * place.x - 0.48 * place.y,
    );
    return turned * step + vec3f(0.37, 0.61, 0.83);
}

// 1.732 where the noise is zero, falling to -1.732 at its extremes, evenly spread: mean 0, standard deviation 1. The
// polynomial is the share of places with a smaller |noise|, fitted to 4 million of them (error 0.005).
fn crease_of(noise: f32) -> f32 {
    let x = min(abs(noise), 2.5);
    let rank = x * (0.838763 + x * (-0.010578 + x * (-0.259687 + x * (0.126188 - x * 0.0195282))));
    return 1.7320508 - 3.4641016 * rank;
}

// Ridges carry the finer layers and valleys stay smooth; the root of 3 keeps the variance.
fn ridge_detail(crease: f32) -> f32 {
    return 0.8660254 + 0.5 * crease;
}

// The share of the noise that lies below `deviation`; `peaked` is the sum of the fourth powers of the weights over the
// squared sum of their squares: 1 for a single octave, 0.6 by default. The corrections were fitted to half a million
// random places for gains of 0.3 to 1 and 1 to 8 octaves. The share is then wrong by at most (single octave; by
// default): fbm 0.010 and 0.004, billow 0.029 and 0.004, ridged 0.052 (two octaves) and 0.027.
fn evened(deviation: f32, peaked: f32, mode: u32) -> f32 {
    let x = clamp(deviation, -3.5, 3.5);
    // Sums of few evenly spread octaves have short tails (excess kurtosis -1.2 × peaked), ridges a long one above (skew
    // 0.47).
    let short_tails = peaked * x * (0.1212 * x * x - 0.2916);
    let long_tail = (1.0 - peaked) * 0.2 * (1.0 - x * x);
    return normal_share(x + select(0.0, short_tails, mode != 0u) + select(0.0, long_tail, mode == 2u));
}
