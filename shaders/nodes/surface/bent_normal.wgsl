//! Bent normal
//! The most open direction of each place, from which light and weather come.
//!
//! The mean of all directions in which nothing is close by, each weighted as it faces the surface.
//! @alias open sky direction unoccluded visibility weather
//! @use rays

struct Params {
    /// Longest distance at which surfaces count.
    /// @length @range 0.00001 1000 @soft 0.01 1 @default 0.1
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 12
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, by the cosine of their angle.
/// @rays params.rays @finds any @reach params.distance
/// @texel min(params.distance / 24, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_out(at, cosine_direction(at.normal, ray_sample(at, index, params.seed)), params.distance);
}

/// The most open direction, of unit length; the normal where all directions are blocked.
/// @vector
fn direction(at: Surface, open: vec3f) -> vec3f {
    let square = dot(open, open);
    return select(at.normal, open * inverseSqrt(max(square, 1e-20)), square > 1e-12);
}

/// Angle between it and the normal: 0 for none, 1 for 90 degrees or more.
fn mask(at: Surface, open: vec3f) -> f32 {
    return clamp(1.0 - dot(direction(at, open), at.normal), 0.0, 1.0);
}

/// The mean of the open directions.
/// @pass 1 @vector @denoise shading
fn open(ray: Ray, hit: Hit) -> vec3f {
    return select(ray.direction, vec3f(0.0), hit.is_hit);
}
