//! Bent normal
//! The way that lies most open: where light and weather come from.
//!
//! The mean of all directions in which nothing is close by, each weighted as it faces the surface.
//! @alias open sky direction unoccluded visibility weather
//! @use rays

struct Params {
    /// How far away something still counts.
    /// @length @range 0.00001 1000 @soft 0.01 1 @default 0.1
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 32
    rays: u32,
    /// Another number, other rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, by the cosine of their angle.
/// @rays params.rays @finds any @reach params.distance
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_out(at, cosine_direction(at.normal, ray_sample(at, index, params.seed)), params.distance);
}

/// The way that lies most open, unit length; the normal where everything is closed.
/// @vector
fn direction(at: Surface, open: vec3f) -> vec3f {
    let square = dot(open, open);
    return select(at.normal, open * inverseSqrt(max(square, 1e-20)), square > 1e-12);
}

/// How far that is from the normal: 0 not at all, 1 by a quarter turn or more.
fn mask(at: Surface, open: vec3f) -> f32 {
    return clamp(1.0 - dot(direction(at, open), at.normal), 0.0, 1.0);
}

/// The mean of the open directions.
/// @pass 1 @vector
fn open(ray: Ray, hit: Hit) -> vec3f {
    return select(ray.direction, vec3f(0.0), hit.is_hit);
}
