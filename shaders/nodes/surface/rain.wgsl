//! Rain
//! How much driving rain hits a place: walls that face the wind, and the dry strip below eaves and sills.
//!
//! Drops fall along the wind, spread a little, and are stopped by everything in their way. Connect it to Flow as the source of
//! the water, or use it for washed and dirty sides.
//! @alias rain wind weather driving exposure wet wash shelter eaves storm directional
//! @use rays

struct Params {
    /// Side that the wind comes out of, about the vertical axis: 0 is the front (+z), 90 the right side (+x).
    /// @angle @range -360 360 @soft -180 180 @default 30
    wind: f32,
    /// Angle of the falling drops from the vertical: 0 falls straight down, 90 blows level.
    /// @angle @range 0 90 @default 30
    slant: f32,
    /// Angle by which the drops' directions vary, as wind shifts: sharp or soft shadows.
    /// @angle @range 0 90 @default 20
    spread: f32,
    /// Longest distance at which something shelters from the rain.
    /// @length @range 0.00001 1000 @soft 0.1 4 @default 2
    distance: f32,
    /// Rays for each place; four times as many halve the noise.
    /// @range 1 1024 @soft 8 256 @default 48
    rays: u32,
    /// Number that chooses the rays.
    /// @seed @default 0
    seed: u32,
}

/// The rays of a place, against the rain.
/// @rays params.rays @finds any @reach params.distance
/// @texel min(params.spread * params.distance / 200, 2 * finest)
fn ray(at: Surface, index: u32, params: Params) -> Ray {
    let sample = ray_sample(at, index, params.seed);
    let wind = turn_of(vec3f(params.wind, params.slant, params.spread));
    let middle = vec3f(wind.sine.x * wind.sine.y, wind.cosine.y, wind.cosine.x * wind.sine.y);
    // Evenly over the cap of directions that drops come out of.
    let turn = turn_of(vec3f(6.2831853 * sample.x, 0.0, 0.0));
    let side = side_of(middle);
    let across = side * turn.cosine.x + cross(middle, side) * turn.sine.x;
    let height = mix(1.0, wind.cosine.z, sample.y);
    let direction = across * sqrt(max(1.0 - height * height, 0.0)) + middle * height;
    // No rain comes up from below, and none from behind.
    let is_above = direction.y >= -1e-4 && dot(direction, at.face_normal) > 0.0 && dot(direction, at.normal) > 0.0;
    return ray_along(at, direction, select(0.0, params.distance, is_above));
}

/// Rain that hits the place: 1 where all drops hit it straight on, 0 where it is sheltered.
fn mask(at: Surface, ray: Ray, hit: Hit) -> f32 {
    return select(dot(ray.direction, at.normal), 0.0, hit.is_hit || ray.reach <= 0.0);
}

/// Mean direction in which the drops that hit fall, of unit length; 0 where none do.
/// @vector
fn direction(at: Surface, fallen: vec3f) -> vec3f {
    let square = dot(fallen, fallen);
    return select(vec3f(0.0), -fallen * inverseSqrt(max(square, 1e-20)), square > 1e-12);
}

/// The mean of the directions that drops come out of, each by what it brings.
/// @pass 1 @vector
fn fallen(at: Surface, ray: Ray, hit: Hit) -> vec3f {
    let brings = select(dot(ray.direction, at.normal), 0.0, hit.is_hit || ray.reach <= 0.0);
    return ray.direction * brings;
}
