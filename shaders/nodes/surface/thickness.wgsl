//! Thickness
//! How thick the model is below each place: tells thin rims, leaves and cloth from solid parts.
//!
//! Rays go inward and end where they leave the model. In a model with holes some never leave it and count as the full
//! distance.
//! @alias thin translucency depth inside subsurface volume
//! @use rays

struct Params {
    /// Thickness that counts as 1; larger ones make no difference.
    /// @length @range 0.00001 1000 @soft 0.01 1 @default 0.1
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 4 128 @default 8
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place: inward, by the cosine of their angle.
/// @rays params.rays @finds nearest @reach params.distance
/// @texel min(params.distance / 16, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    let inward = cosine_direction(-at.face_normal, ray_sample(at, index, params.seed));
    return ray_along(at, inward, params.distance);
}

/// Mean length of the rays, as a share of Distance.
/// @pass 1 @denoise shading
fn way(hit: Hit, params: Params) -> f32 {
    return hit.distance / params.distance;
}

/// Mean thickness as a share of Distance: 0 is as thin as paper, 1 is thick.
fn mask(way: f32) -> f32 {
    return way;
}

/// Mean thickness in working units; at most Distance.
fn depth(way: f32, params: Params) -> f32 {
    return way * params.distance;
}
