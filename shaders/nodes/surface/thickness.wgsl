//! Thickness
//! How deep the model is below each place: thin rims, leaves and cloth against solid parts.
//!
//! Rays go inward and end where they leave the model again. Where it is open, they may leave it nowhere and count as the
//! full distance.
//! @alias thin translucency depth inside subsurface volume
//! @use rays

struct Params {
    /// What counts as thick; deeper makes no difference.
    /// @length @range 0.00001 1000 @soft 0.01 1 @default 0.1
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 4 128 @default 16
    rays: u32,
    /// Another number, other rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place: inward, by the cosine of their angle.
/// @rays params.rays @finds nearest @reach params.distance
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    let inward = cosine_direction(-at.face_normal, ray_sample(at, index, params.seed));
    return ray_along(at, inward, params.distance);
}

/// The mean depth as a share of the distance: 0 as thin as paper, 1 thick.
fn mask(hit: Hit, params: Params) -> f32 {
    return hit.distance / params.distance;
}

/// The mean depth in model units, the distance at most.
fn depth(hit: Hit) -> f32 {
    return hit.distance;
}
