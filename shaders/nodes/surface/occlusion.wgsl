//! Occlusion
//! How enclosed each place is: high in creases, in corners and below overhangs.
//!
//! Rays go out from each place into the hemisphere above the surface, most of them along the normal; the mask is the share
//! that hits the model within the distance. Dust and dirt lie where it is high.
//! @alias ao ambient occlusion crevice crease corner dirt shadow exposure hbao
//! @use rays

struct Params {
    /// Longest distance at which surfaces count.
    /// @length @range 0.00001 1000 @soft 0.01 1 @default 0.1
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 4 128 @default 8
    rays: u32,
    /// Whether surfaces count the same up to the distance (none), or less the farther they are (linear).
    /// @choice none linear @default none
    falloff: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place: by the cosine of their angle, so that what stands upright over it counts most.
/// @rays params.rays @finds any @reach params.distance
/// @texel min(params.distance / 24, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    // A ray that ends at a random share of the distance meets what stands at a given distance the less often, the further
    // that is.
    let share = select(1.0, 1.0 - ray_number(at, index, params.seed), params.falloff == 1u);
    let direction = cosine_direction(at.normal, ray_sample(at, index, params.seed));
    return ray_out(at, direction, params.distance * share);
}

/// The share of rays that are stopped.
/// @pass 1 @denoise shading
fn stopped(hit: Hit) -> f32 {
    return select(0.0, 1.0, hit.is_hit);
}

/// 0 in the open, 1 where all rays hit the model.
fn mask(stopped: f32) -> f32 {
    return stopped;
}

/// The inverse: 1 in the open, as in occlusion maps.
fn ao(stopped: f32) -> f32 {
    return 1.0 - stopped;
}
