//! Contact
//! Where another piece of the model stands close: rust that bleeds from bolts, dirt and wear where pieces meet.
//!
//! Rays go out from each place, and only those that meet another piece count; creases and folds of the place's own piece do
//! not. A piece is whatever hangs together, such as one plank of a bench or one link of a chain.
//! @alias contact neighbor touching proximity join joint gap bleed bolt rust pieces parts intersection crevice
//! @use rays atlas

struct Params {
    /// Longest distance at which another piece counts.
    /// @length @range 0.00001 1000 @soft 0.005 0.5 @default 0.05
    distance: f32,
    /// How fast the mask falls with the distance to the other piece: 0 counts all up to the distance alike, 1 falls off
    /// evenly, more keeps to where pieces touch.
    /// @range 0 8 @soft 0 4 @default 1
    falloff: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 24
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, evenly over the half of all directions that is outside.
/// @rays params.rays @finds nearest @reach params.distance
/// @texel max(min(params.distance / 12, 2 * finest), min(params.distance / 24, 4 * finest))
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    let sample = ray_sample(at, index, params.seed);
    let turn = turn_of(vec3f(6.2831853 * sample.x, 0.0, 0.0));
    let side = side_of(at.face_normal);
    let around = side * turn.cosine.x + cross(at.face_normal, side) * turn.sine.x;
    // By the sine of the angle: a piece that stands on this one is seen from the side, one that lies on it from above.
    let direction = around * sqrt(1.0 - sample.y * sample.y) + at.face_normal * sample.y;
    return ray_along(at, direction, params.distance);
}

/// Sums over the rays: how close others are, that times their random values, and the share of rays that meet them.
/// @pass 1 @vector
fn others(at: Surface, ray: Ray, hit: Hit, params: Params) -> vec3f {
    let piece = piece_hit(hit);
    let is_other = is_other_piece(at, hit);
    let near = closeness(ray, hit, params);
    return select(vec3f(0.0), vec3f(near, near * piece_random(piece), 1.0), is_other);
}

/// The way to the others, the closer ones more.
/// @pass 2 @vector
fn way(at: Surface, ray: Ray, hit: Hit, params: Params) -> vec3f {
    return select(vec3f(0.0), ray.direction * closeness(ray, hit, params), is_other_piece(at, hit));
}

/// Mean distance of the others as a share of the distance, times the share of rays that meet them.
/// @pass 3
fn apart(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return select(0.0, hit.distance / max(ray.reach, 1e-12), is_other_piece(at, hit));
}

/// 1 where another piece touches, 0 where none is within the distance.
fn mask(others: vec3f) -> f32 {
    // A wall that stands upright on this place takes half of the directions.
    return clamp(2.0 * others.x, 0.0, 1.0);
}

/// The random value of the other piece, as Parts gives it by piece; the closest ones mixed, 0 where none is within the
/// distance.
fn id(others: vec3f) -> f32 {
    return select(0.0, others.y / max(others.x, 1e-6), others.x > 0.0);
}

/// Mean distance to the others as a share of Distance: 0 where one touches, 1 where none is within it.
fn away(others: vec3f, apart: f32) -> f32 {
    // A few rays that pass close over the surface are noise and no neighbor.
    let share = smoothstep(0.02, 0.1, others.z);
    return mix(1.0, clamp(apart / max(others.z, 1e-6), 0.0, 1.0), share);
}

/// Direction to the others, in model space, unit length; 0 where none is within the distance.
/// @vector
fn toward(way: vec3f) -> vec3f {
    return unit_or(way, vec3f(0.0));
}

// The piece of the triangle that was hit; it stands with the chart of the triangle.
fn piece_hit(hit: Hit) -> u32 {
    let triangle = select(0u, hit.triangle, hit.is_hit);
    return bitcast<u32>(frame_row(triangle * FRAME_ROWS + 3u).w);
}

fn is_other_piece(at: Surface, hit: Hit) -> bool {
    return hit.is_hit && piece_hit(hit) != at.piece;
}

// 1 at a hit right here, 0 at the distance.
fn closeness(ray: Ray, hit: Hit, params: Params) -> f32 {
    let near = clamp(1.0 - hit.distance / max(ray.reach, 1e-12), 0.0, 1.0);
    return select(pow(max(near, 1e-9), params.falloff), 1.0, params.falloff <= 0.0);
}
