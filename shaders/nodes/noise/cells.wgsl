//! Cells
//! Distance to the nearest of many points scattered through space: pits, pebbles, scales.
//!
//! Each cube of space holds one point; the mask is 0 at a point and grows to about 1 where cells meet. Cells that
//! are too small for the texels fade to their mean.
//! @alias worley voronoi cellular pebbles pits scales spots tile sampler
//! @use cells

struct Params {
    /// Mean distance of neighboring points.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Above 1 only the borders between cells stay bright, as narrow ridges; below 1 only the points stay dark, as
    /// pits.
    /// @range 0.05 20 @soft 0.2 5 @default 1
    sharpness: f32,
    /// Irregularity: how far the points are from a regular grid.
    /// @range 0 1 @default 1
    jitter: f32,
    /// Stretches the cells along the axes of the pattern.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Number that chooses one of many patterns of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The nearest point.
/// @shared
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn nearest(position: vec3f, params: Params) -> NearestPoint {
    let place = cells_place(position, params.size, params.stretch, params.rotate);
    return nearest_point(place, params.jitter, seed_key(params.seed), 0.0);
}

/// The distance: 0 at a point, about 1 where cells meet.
fn mask(at: Surface, nearest: NearestPoint, params: Params) -> f32 {
    let wavelength = params.size * finest_stretch(params.stretch);
    // The longest distance on a regular grid; with full jitter 99.9 % of all places are nearer than 1.
    let distance = min(nearest.distance / mix(0.8660254, 1.0, params.jitter), 1.0);
    let seen = carried(wavelength, at.texel_size);
    return mix(mean_sharpened(params.jitter, params.sharpness), sharpened(distance, params.sharpness), seen);
}

/// A random value for each cell.
fn id(nearest: NearestPoint) -> f32 {
    return unit_random(nearest.id);
}

// Keeps 0, 1 and, at a sharpness of 1, everything; its slope is 1 / sharpness at 0 and sharpness at 1.
fn sharpened(x: f32, sharpness: f32) -> f32 {
    return x / (x + sharpness * (1.0 - x));
}

// The mean of the mask over space, to second order in the spread of the distance. Mean and variance (0.028) of the
// distance were measured over a million places for each of five jitters.
fn mean_sharpened(jitter: f32, sharpness: f32) -> f32 {
    let mean = 0.520 + 0.0346 * (1.0 - jitter) * (1.0 - jitter);
    let rest = sharpness + (1.0 - sharpness) * mean;
    let bend = 2.0 * sharpness * (sharpness - 1.0) / (rest * rest * rest);
    return clamp(sharpened(mean, sharpness) + 0.5 * 0.028 * bend, 0.0, 1.0);
}
