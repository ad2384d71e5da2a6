//! Sunlight
//! How much sunlight a place has got, behind everything that shades it: bleaching, chalking, drying; inverted, where moss grows.
//!
//! The sun moves over a part of the sky, or along its path from east to west; the rest of the light comes from the whole sky.
//! Each ray counts by the cosine of its angle on the surface. Direction is that which most of the light comes from.
//! @alias sun dose exposure fade bleach uv light shadow sky north side directional
//! @use rays

struct Params {
    /// Direction of the sun at noon, in model space.
    /// @default 0.4 0.8 0.45
    toward: vec3f,
    /// Angle by which the sun moves away from there.
    /// @angle @range 0 90 @default 40
    spread: f32,
    /// Where the sun moves: evenly over a round part of the sky, or along its path over a day, level at noon and to both sides
    /// of it. With a Spread of 90° the path is half a circle.
    /// @choice sky path @default sky
    moves: u32,
    /// Share of the light that comes from the whole sky.
    /// @range 0 1 @default 0.25
    sky: f32,
    /// Longest distance at which something casts a shadow.
    /// @length @range 0.00001 1000 @soft 0.1 4 @default 2
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 48
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, toward the light.
/// @rays params.rays @finds any @reach params.distance
/// @texel min(params.spread * params.distance / 200, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    let sample = ray_sample(at, index, params.seed);
    let square = dot(params.toward, params.toward);
    let sun = select(vec3f(0.0, 1.0, 0.0), params.toward * inverseSqrt(max(square, 1e-30)), square > 1e-12);
    // Evenly over the cap of the sky that the sun moves in.
    let turn = turn_of(vec3f(6.2831853 * sample.x, params.spread, 0.0));
    let side = side_of(sun);
    // The first samples are for the sky, the others for the sun, so that both have their exact shares.
    let is_of_sky = sample.y < params.sky;
    let share = select(1.0 - params.sky, params.sky, is_of_sky);
    let rest = clamp((sample.y - select(params.sky, 0.0, is_of_sky)) / max(share, 1e-6), 0.0, 1.0);
    let height = mix(1.0, turn.cosine.y, rest);
    let across = side * turn.cosine.x + cross(sun, side) * turn.sine.x;
    let in_cap = across * sqrt(max(1.0 - height * height, 0.0)) + sun * height;
    // Along a great circle that is level at noon.
    let east = unit_or(cross(vec3f(0.0, 1.0, 0.0), sun), vec3f(1.0, 0.0, 0.0));
    let hour = turn_of(vec3f((2.0 * rest - 1.0) * params.spread, 0.0, 0.0));
    let in_path = select(in_cap, sun * hour.cosine.x + east * hour.sine.x, params.moves == 1u);
    // The sky is as bright everywhere: evenly over the upper half.
    let dome = turn_of(vec3f(6.2831853 * sample.x, 0.0, 0.0));
    let ring = sqrt(max(1.0 - rest * rest, 0.0));
    let in_sky = vec3f(dome.cosine.x * ring, rest, dome.sine.x * ring);
    let direction = select(in_path, in_sky, is_of_sky);
    // The sun below the horizon gives no light.
    let is_above = direction.y >= 0.0 && dot(direction, at.face_normal) > 0.0 && dot(direction, at.normal) > 0.0;
    return ray_along(at, direction, select(0.0, params.distance, is_above));
}

/// Light that arrives, each part of it by the cosine of its angle: 0 in the shade, 1 where all of it came straight down.
fn mask(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return arrives(at, ray, hit);
}

/// The light by its direction.
/// @pass 1 @vector
fn light(at: Surface, ray: Ray, hit: Hit) -> vec3f {
    return ray.direction * arrives(at, ray, hit);
}

/// Direction that most of the light comes from, in model space, unit length; 0 in the shade.
/// @vector
fn direction(light: vec3f) -> vec3f {
    return unit_or(light, vec3f(0.0));
}

fn arrives(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return select(dot(ray.direction, at.normal), 0.0, hit.is_hit || ray.reach <= 0.0);
}
