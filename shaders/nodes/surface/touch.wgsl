//! Touch
//! Where a ball of some size can touch the surface: what hands, boots and boxes reach and wear.
//!
//! High on open sides and edges, low in grooves and corners that the ball does not fit into. Rays follow the chords of the
//! ball that lies on each place; the mask is the share of them that meet nothing.
//! @alias accessibility tangent sphere reach wear exposed hands ball polish contact rub
//! @use rays

struct Params {
    /// Diameter of the ball.
    /// @length @range 0.00001 1000 @soft 0.02 1 @default 0.3
    diameter: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 12
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place: chords of the ball, from the place where it touches to its other side.
/// @rays params.rays @finds any @reach params.diameter
/// @texel max(min(params.diameter / 24, 2 * finest), min(params.diameter / 48, 4 * finest))
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    // The ball lies on the triangle: on shading that bends away from it, it would cut into flat sides.
    let direction = cosine_direction(at.face_normal, ray_sample(at, index, params.seed));
    // A chord is as long as the diameter times the cosine of its angle; a little less, so that a ball that just fits does.
    return ray_along(at, direction, 0.99 * params.diameter * dot(direction, at.face_normal));
}

/// The share of chords that meet nothing.
/// @pass 1 @denoise shading
fn free(hit: Hit) -> f32 {
    return select(1.0, 0.0, hit.is_hit);
}

/// 1 where the ball touches, 0 where it does not get near.
fn mask(free: f32) -> f32 {
    return free;
}
