//! Cells
//! Distance to the nearest of many points scattered through space: pits, pebbles, scales.
//!
//! Each cube of space holds one point; the mask is 0 at a point and grows to about 1 where cells meet. Cells that the
//! texels cannot carry fade to their mean.
//! @alias worley voronoi cellular pebbles pits scales spots
//! @use noise

struct Params {
    /// Mean distance of neighboring points.
    /// @length @range 0.0001 100 @soft 0.01 0.5 @default 0.1
    size: f32,
    /// Above 1 only the borders between cells stay bright, as narrow ridges; below 1 only the points stay dark, as
    /// pits.
    /// @range 0.05 20 @soft 0.2 5 @default 1
    sharpness: f32,
    /// How far the points stray from a regular grid.
    /// @range 0 1 @default 1
    jitter: f32,
    /// Draws the cells out along their own axes.
    /// @range 0.01 100 @soft 0.1 10 @default 1 1 1
    stretch: vec3f,
    /// Turns the pattern about the model's axes: x first, then y, then z.
    /// @angle @range -360 360 @soft -180 180 @default 0 0 0
    rotate: vec3f,
    /// Another number, another pattern of the same kind.
    /// @seed @default 0
    seed: u32,
}

/// The distance: 0 at a point, about 1 where cells meet.
/// @input position Where the noise is read; connect a moved position to warp it. @vector @optional @default at.position
fn mask(at: Surface, position: vec3f, params: Params) -> f32 {
    let nearest = nearest_point(position, params);
    let wavelength = params.size * finest_stretch(params.stretch);
    // The longest distance on a regular grid; with full jitter 99.9 % of all places are nearer than 1.
    let distance = min(nearest.distance / mix(0.8660254, 1.0, params.jitter), 1.0);
    let seen = carried(wavelength, at.texel_size);
    return mix(mean_sharpened(params.jitter, params.sharpness), sharpened(distance, params.sharpness), seen);
}

/// A random value for each cell.
fn id(position: vec3f, params: Params) -> f32 {
    return unit_random(nearest_point(position, params).id);
}

// Keeps 0, 1 and, at a sharpness of 1, everything; its slope is 1 / sharpness at 0 and sharpness at 1.
fn sharpened(x: f32, sharpness: f32) -> f32 {
    return x / (x + sharpness * (1.0 - x));
}

// The mean of the mask over space, to second order in the spread of the distance. Mean and variance (0.028) of the
// distance were measured over a million places for each of five jitters.
fn mean_sharpened(jitter: f32, sharpness: f32) -> f32 {
    let mean = 0.520 + 0.0346 * (1.0 - jitter) * (1.0 - jitter);
    let rest = sharpness + (1.0 - sharpness) * mean;
    let bend = 2.0 * sharpness * (sharpness - 1.0) / (rest * rest * rest);
    return clamp(sharpened(mean, sharpness) + 0.5 * 0.028 * bend, 0.0, 1.0);
}

struct Nearest {
    distance: f32,
    id: u32,
}

// The nearest point, in cells. Exact: along each axis the cells are taken in the order of their distance, own cell
// first, and an axis is left as soon as its cells are further away than the nearest point so far. The own cell's point
// is less than two cells away, so two cells to each side are enough; about a dozen of the 125 are looked at.
fn nearest_point(position: vec3f, params: Params) -> Nearest {
    // Part of a cell away from the origin, where flat sides of models like to lie.
    let offset = vec3f(0.2713, 0.3137, 0.2299);
    let place = wrapped(noise_place(position, params.stretch, params.rotate) / params.size + offset);
    let key = seed_key(params.seed);
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    // Toward the nearer border of each axis, and how far it is.
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    var nearest = Nearest(16.0, 0u);
    for (var i = 0; i < 5; i++) {
        let z = axis_distance(i, border.z);
        if z * z >= nearest.distance {
            break;
        }
        for (var j = 0; j < 5; j++) {
            let y = axis_distance(j, border.y);
            if z * z + y * y >= nearest.distance {
                break;
            }
            for (var k = 0; k < 5; k++) {
                let x = axis_distance(k, border.x);
                if z * z + y * y + x * x >= nearest.distance {
                    break;
                }
                let step = vec3i(axis_step(k, side.x), axis_step(j, side.y), axis_step(i, side.z));
                let random = cell_random(cell + step, key);
                let point = vec3f(step) + 0.5 + params.jitter * (unit_random3(random) - 0.5);
                let square = dot(point - inside, point - inside);
                let nearer = square < nearest.distance;
                nearest.distance = select(nearest.distance, square, nearer);
                nearest.id = select(nearest.id, random.x, nearer);
            }
        }
    }
    nearest.distance = sqrt(nearest.distance);
    return nearest;
}

// Offsets of the cells of an axis by rising distance: 0, side, -side, 2 side, -2 side.
fn axis_step(index: i32, side: i32) -> i32 {
    return ((index + 1) >> 1u) * select(-side, side, (index & 1) == 1);
}

// Distance to the cell at that offset, when the nearer border is `border` away. A hair less than the truth: rounding
// must not leave out a cell.
fn axis_distance(index: i32, border: f32) -> f32 {
    let cells = f32((index + 1) >> 1u);
    let away = select(cells - border, cells - 1.0 + border, (index & 1) == 1);
    return select(max(away - 1e-5, 0.0), 0.0, index == 0);
}
