//! White noise
//! A random value for each small cube of space.
//!
//! The cubes stand in the model's space, so the pattern is the same at every resolution. Where they are smaller than
//! the texels, the mask fades to its mean, as the eye would average it.
//! @alias white random static speckle sand value
//! @use noise

struct Params {
    /// Side of a cube.
    /// @length @range 0.0001 100 @soft 0.002 0.2 @default 0.01
    size: f32,
    /// Stretches the cubes along the axes of the pattern.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The random value, spread evenly over 0 to 1.
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    // Two cubes make a wave.
    let wavelength = 2.0 * params.size * finest_stretch(params.stretch);
    return mix(0.5, unit_random(grain(position, params).x), carried(wavelength, at.texel_size));
}

/// A second random value for each cube, independent of the mask and never faded.
fn id(position: vec3f, params: Params) -> f32 {
    return unit_random(grain(position, params).y);
}

fn grain(position: vec3f, params: Params) -> vec3u {
    // A quarter of a cube away from the origin, where flat sides of models like to lie: on a border, rounding would
    // decide.
    let place = noise_place(position, params.stretch, params.rotate) / params.size + vec3f(0.2713, 0.3137, 0.2299);
    return cell_random(cell_of(wrapped(place)), seed_key(params.seed));
}
