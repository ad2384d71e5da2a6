//! Rounded normal
//! Shades hard edges as if they were beveled: connect it to the slope of Combine material.
//!
//! Within the radius of an edge, the normal turns smoothly from one side to the other. Away from edges it is exactly the
//! model's own normal. The model itself is not changed.
//! @alias bevel chamfer rounded edge soft edge normal fillet
//! @use rays

struct Params {
    /// Distance from an edge that the rounding reaches.
    /// @length @range 0.00001 1000 @soft 0.001 0.05 @default 0.01
    radius: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 4 1024 @soft 8 128 @default 16
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, to all sides alike.
/// @rays params.rays @finds nearest @reach params.radius
/// @texel min(params.radius / 6, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    return ray_around(at, index, params.seed, params.radius);
}

/// The slope of the bevel.
/// @vector
fn slope(at: Surface, change: vec3f) -> vec3f {
    let rounded = rounded_by(at, change);
    // What leans by more than 80 degrees has no slope that a map could hold.
    return at.normal - rounded / max(dot(at.normal, rounded), 0.17);
}

/// Angle between the rounded normal and the model's: 0 away from edges, 1 for 90 degrees.
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
