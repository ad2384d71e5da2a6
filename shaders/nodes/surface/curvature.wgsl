//! Curvature
//! How the surface bends: edges and bumps above 0, creases and hollows below.
//!
//! Rays go out to all sides of a place; the result is the share of them that hits the model from inside minus the share that
//! hits it from outside. It does not depend on the triangles of the model: an edge of 90 degrees gives 0.5, one of 45
//! degrees 0.25, and the values fall evenly to 0 within the radius.
//! @alias convex concave bend edge crease wear pointiness
//! @use rays

struct Params {
    /// Length of the rays.
    /// @length @range 0.00001 1000 @soft 0.002 0.2 @default 0.02
    radius: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 2 1024 @soft 8 256 @default 12
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds any @reach params.radius
/// @texel max(min(params.radius / 10, 2 * finest), min(params.radius / 20, 4 * finest))
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.radius);
}

/// Curvature: above 0 where the surface is convex, below where it is concave.
fn mask(bend: f32) -> f32 {
    return bend;
}

/// The share of rays stopped inside less those stopped outside.
/// @pass 1 @denoise triangles
fn bend(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return bend_by(at, ray, hit);
}
