//! Cavity
//! Creases and hollows, where dirt gathers.
//!
//! The mask depends on the angle of a crease and on Width, and not on the triangles of the model.
//! @alias crease concave hollow groove dirt grime curvature grunge
//! @use rays

struct Params {
    /// Distance from a crease that the mask reaches.
    /// @length @range 0.00001 1000 @soft 0.002 0.1 @default 0.02
    width: f32,
    /// Smallest angle of a crease that counts.
    /// @angle @range 0 180 @soft 5 90 @default 30
    angle: f32,
    /// How softly the mask falls off: 0 is a sharp band, 1 fades over the whole width.
    /// @range 0 1 @default 0.5
    softness: f32,
    /// Whether to ignore edges with smooth shading, such as those between the facets of a round column.
    /// @toggle @default on
    smooth_groups: u32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 2 1024 @soft 8 256 @default 12
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds nearest @reach params.width @turn params.angle
/// @texel max(min(params.width / 10, 2 * finest), min(params.width / 20, 4 * finest))
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.width);
}

/// 1 in creases, 0 away from them.
fn mask(bend: f32, params: Params) -> f32 {
    return bent_beyond(-bend, params.angle, params.softness);
}

/// The share of rays stopped inside less those stopped outside.
/// @pass 1 @denoise triangles
fn bend(at: Surface, ray: Ray, hit: Hit, params: Params) -> f32 {
    return bend_by(at, ray, hit) * crease_share(at, ray, hit, params.angle, params.smooth_groups == 1u);
}
