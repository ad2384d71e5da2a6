//! Edges
//! The edges that stick out: where paint is worn off and corners break.
//!
//! It does not hang on how finely the model is cut into triangles, only on how sharply an edge turns and how wide the wear is
//! to be. Noise times edges makes wear; edges alone make a clean rim.
//! @alias edge wear convex rim corner chipped curvature
//! @use rays

struct Params {
    /// How far from an edge the mask reaches.
    /// @length @range 0.00001 1000 @soft 0.002 0.1 @default 0.02
    width: f32,
    /// Edges that turn by less do not count.
    /// @angle @range 0 180 @soft 5 90 @default 30
    angle: f32,
    /// How softly the mask falls off: 0 is a sharp band, 1 fades over the whole width.
    /// @range 0 1 @default 0.5
    softness: f32,
    /// Whether edges inside smooth shading do not count, as those between the facets of a round column.
    /// @toggle @default on
    smooth_groups: u32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 2 1024 @soft 8 256 @default 32
    rays: u32,
    /// Another number, other rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds nearest @reach params.width
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.width);
}

/// 1 on edges that stick out, 0 away from them.
fn mask(bend: f32, params: Params) -> f32 {
    return bent_beyond(bend, params.angle, params.softness);
}

/// The share of rays stopped inside less those stopped outside.
/// @pass 1
fn bend(at: Surface, ray: Ray, hit: Hit, params: Params) -> f32 {
    return bend_by(at, ray, hit) * select(1.0, shaded_share(at, ray, hit), params.smooth_groups == 1u);
}
