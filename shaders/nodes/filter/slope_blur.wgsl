//! Slope blur
//! Smears a mask along the slopes of another one: chipped borders, crumbling paint, running color.
//! @alias smear erode directional flow chip
//! @use slope

struct Params {
    /// Longest distance of the smear.
    /// @length @range -1 1 @soft -0.1 0.1 @default 0.02
    distance: f32,
    /// Value taken from the places on the way: their mean, the smallest or the largest.
    /// @choice mean min max @default mean
    mode: u32,
    /// Number of places read on the way.
    /// @range 2 48 @soft 4 32 @default 12
    samples: u32,
}

/// The slopes that it goes along, without detail that is small against the way.
/// @pass 1 @vector @texel abs(params.distance) / 8
/// @input by The mask whose slopes are followed.
/// @type mask
fn slope(at: Surface, by: texture_2d_array<f32>) -> vec3f {
    return surface_gradient(by, at);
}

/// The smeared mask.
/// @input source The mask to smear.
fn mask(at: Surface, params: Params, source: texture_2d_array<f32>, slope: texture_2d_array<f32>) -> f32 {
    var walk = surface_standing(at);
    let own = surface_here(source, at).x;
    var sum = own;
    var low = own;
    var high = own;
    for (var index = 1u; index < params.samples; index++) {
        let way = slope_way(surface_sample(slope, walk).xyz, params.distance);
        walk = surface_walk(walk, way / f32(params.samples - 1u));
        let value = surface_sample(source, walk).x;
        sum += value;
        low = min(low, value);
        high = max(high, value);
    }
    let mean = sum / f32(params.samples);
    return select(select(mean, low, params.mode == 1u), high, params.mode == 2u);
}
