//! Rounded normal
//! Hard edges shaded as if they were bevelled: give it to Combine material as its slope.
//!
//! The normal becomes the mean direction of the air in a ball around each place, which turns over an edge from one side to
//! the other within the radius. Away from edges it is the model's own normal to the last bit. The model stays as it is.
//! @alias bevel chamfer rounded edge soft edge normal fillet
//! @use rays

struct Params {
    /// How far from an edge the rounding reaches.
    /// @length @range 0.00001 1000 @soft 0.001 0.05 @default 0.01
    radius: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 4 1024 @soft 8 128 @default 16
    rays: u32,
    /// Another number, other rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds nearest @reach params.radius
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.radius);
}

/// How the normal leans against the model's: the slope of the bevel.
/// @vector
fn slope(at: Surface, change: vec3f) -> vec3f {
    let rounded = rounded_by(at, change);
    // What leans by more than 80 degrees has no slope that a map could hold.
    return at.normal - rounded / max(dot(at.normal, rounded), 0.17);
}

/// How far it leans: 0 away from edges, 1 by a quarter turn.
fn mask(at: Surface, change: vec3f) -> f32 {
    return acos(clamp(dot(at.normal, rounded_by(at, change)), 0.0, 1.0)) * 0.63661977;
}

/// What edges nearby take from the air above the surface, or add below it: by volume, where a plane has nothing to say.
/// @pass 1 @vector
fn change(at: Surface, ray: Ray, hit: Hit) -> vec3f {
    let share = hit.distance / ray.reach;
    let beyond = 1.0 - share * share * share;
    return -sign(dot(ray.direction, at.face_normal)) * ray.direction * (beyond * shaded_share(at, ray, hit));
}

// Over half a ball all of the air's directions together have a quarter of its normal.
fn rounded_by(at: Surface, change: vec3f) -> vec3f {
    return unit_or(at.normal * 0.25 + change, at.normal);
}
