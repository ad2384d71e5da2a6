//! Warp positions
//! Moves the positions at which noises are read: straight lines become wavy, round shapes uneven.
//!
//! Connect the result to Position of a noise. The node moves positions by its own soft noise; a vector connected
//! to By is added, and with Turbulence at 0 it is the only movement.
//! @alias warp distort domain turbulence wobble wavy swirl
//! @use noise

struct Params {
    /// Distance by which positions are moved.
    /// @length @range -100 100 @soft 0 0.3 @default 0.05
    amount: f32,
    /// Strength of the node's own noise.
    /// @range 0 10 @soft 0 1 @default 1
    turbulence: f32,
    /// Size of the largest waves of the node's own noise.
    /// @length @range 0.0001 100 @soft 0.02 1 @default 0.3
    size: f32,
    /// Number of finer layers of that noise.
    /// @label Detail @range 1 8 @default 2
    octaves: u32,
    /// Number that chooses one of many noises of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The moved position.
/// @vector
/// @input position The position to move. @vector @optional @default at.position
/// @input by Movement, multiplied by Amount and added to the node's own noise. @vector @optional @default 0 0 0
fn vector(at: Surface, position: vec3f, by: vec3f, params: Params) -> vec3f {
    var place = position / params.size;
    var key = seed_key(params.seed);
    var wavelength = params.size;
    var weight = 1.0;
    var whole = 0.0;
    var sum = vec3f(0.0);
    for (var i = 0u; i < params.octaves; i++) {
        // Three noises, far apart in the hash.
        let noise = vec3f(
            simplex_noise(place + 0.31, key),
            simplex_noise(place + 0.67, key + vec3u(0x51ed270bu, 0x2545f491u, 0x6c8e9cf5u)),
            simplex_noise(place + 0.13, key + vec3u(0xa3d95fa7u, 0xd6e8feb9u, 0x1b56c4e9u)),
        );
        sum += noise * (weight * carried(wavelength, at.texel_size));
        whole += weight * weight;
        weight *= 0.5;
        wavelength *= 0.5;
        key += vec3u(0x9e3779b9u, 0x85ebca6bu, 0xc2b2ae35u);
        place = vec3f(place.y, place.z, place.x) * 2.0 + vec3f(0.37, 0.61, 0.83);
    }
    // The noise moves places by 1 in the mean of the squares.
    let own = sum * inverseSqrt(3.0 * whole);
    return position + params.amount * (by + params.turbulence * own);
}
