//! Points scattered through space, one in each cube: the nearest of them, and the walls between their cells.
//!
//! Places and distances are in cubes, in the noise's own space.
//! @use noise

/// The point nearest to a place.
struct NearestPoint {
    /// How far it is.
    distance: f32,
    /// How far the one after it is, as far as it was looked for.
    second: f32,
    /// Its random number.
    id: u32,
    /// From the place to the point.
    offset: vec3f,
}

/// Where the cubes of a length stand: part of a cube away from the origin, where flat sides of models like to lie.
fn cells_place(position: vec3f, size: f32, stretch: vec3f, rotate: vec3f) -> vec3f {
    return wrapped(noise_place(position, stretch, rotate) / size + vec3f(0.2713, 0.3137, 0.2299));
}

/// The point of a cube, from the cube's corner.
fn cell_point(random: vec3u, jitter: f32) -> vec3f {
    return 0.5 + jitter * (unit_random3(random) - 0.5);
}

/// The nearest point, and the second one if it is at most `margin` further away.
///
/// Exact: along each axis the cubes are taken in the order of their distance, own cube first, and an axis is left as
/// soon as its cubes are further away than what is looked for. The own cube's point is less than two cubes away, so two
/// cubes to each side are enough; about a dozen of the 125 are looked at.
fn nearest_point(place: vec3f, jitter: f32, key: vec3u, margin: f32) -> NearestPoint {
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    // Toward the nearer border of each axis, and how far it is.
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    var nearest = NearestPoint(16.0, 16.0, 0u, vec3f(0.0));
    var limit = 16.0;
    for (var i = 0; i < 5; i++) {
        let z = axis_distance(i, border.z);
        if z * z >= limit {
            break;
        }
        for (var j = 0; j < 5; j++) {
            let y = axis_distance(j, border.y);
            if z * z + y * y >= limit {
                break;
            }
            for (var k = 0; k < 5; k++) {
                let x = axis_distance(k, border.x);
                if z * z + y * y + x * x >= limit {
                    break;
                }
                let step = vec3i(axis_step(k, side.x), axis_step(j, side.y), axis_step(i, side.z));
                let random = cell_random(cell + step, key);
                let offset = vec3f(step) + cell_point(random, jitter) - inside;
                let square = dot(offset, offset);
                let nearer = square < nearest.distance;
                nearest.second = min(nearest.second, max(square, nearest.distance));
                nearest.distance = select(nearest.distance, square, nearer);
                nearest.id = select(nearest.id, random.x, nearer);
                nearest.offset = select(nearest.offset, offset, nearer);
                let reach = sqrt(nearest.distance) + margin;
                limit = reach * reach;
            }
        }
    }
    nearest.distance = sqrt(nearest.distance);
    nearest.second = sqrt(nearest.second);
    return nearest;
}

/// A wall between two cells, as the surface cuts it.
struct Wall {
    /// How far it is along the surface.
    distance: f32,
    /// Across it, in the noise's own axes; any length.
    across: vec3f,
}

/// How far it is, along the surface, to the nearest wall between the cell of `nearest` and another one: `reach` if it is
/// further than that. Lengths are in cubes that are not stretched; `normal` is the surface's, in the noise's own axes.
///
/// A wall is the plane in the middle between two points. Where the surface cuts it, the cut of the cell is a polygon
/// whose sides are further away than their planes, by the tangential part of the walls' normals; the least of those
/// distances is exactly that to the polygon on a plane. Walls almost along the surface count as if they stood at 12
/// degrees, or they would cover it.
fn nearest_wall(
    place: vec3f, nearest: NearestPoint, jitter: f32, key: vec3u, stretch: vec3f, normal: vec3f, reach: f32,
) -> Wall {
    let finest = finest_stretch(stretch);
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    let side = select(vec3i(-1), vec3i(1), inside > vec3f(0.5));
    let border = min(inside, 1.0 - inside);
    var least = Wall(reach, normal.zxy);
    // The plane between the nearest point and one in a cube at the distance b is at least (b - nearest) / 2 away.
    var limit = nearest.distance + 2.0 * least.distance / finest;
    limit *= limit;
    for (var i = 0; i < 7; i++) {
        let z = axis_distance(i, border.z);
        if z * z >= limit {
            break;
        }
        for (var j = 0; j < 7; j++) {
            let y = axis_distance(j, border.y);
            if z * z + y * y >= limit {
                break;
            }
            for (var k = 0; k < 7; k++) {
                let x = axis_distance(k, border.x);
                if z * z + y * y + x * x >= limit {
                    break;
                }
                let step = vec3i(axis_step(k, side.x), axis_step(j, side.y), axis_step(i, side.z));
                let offset = vec3f(step) + cell_point(cell_random(cell + step, key), jitter) - inside;
                let between = offset - nearest.offset;
                let square = dot(between, between);
                let steep = between / stretch;
                let rise = dot(steep, normal);
                let whole = dot(steep, steep);
                let along = max(whole - rise * rise, 0.04 * whole);
                let away = 0.5 * dot(nearest.offset + offset, between) * inverseSqrt(max(along, 1e-30));
                let nearer = square > 1e-12 && away < least.distance;
                least.distance = select(least.distance, max(away, 0.0), nearer);
                least.across = select(least.across, steep - rise * normal, nearer);
                limit = nearest.distance + 2.0 * least.distance / finest;
                limit *= limit;
            }
        }
    }
    return least;
}

/// Offsets of the cubes of an axis by rising distance: 0, side, -side, 2 side, -2 side.
fn axis_step(index: i32, side: i32) -> i32 {
    return ((index + 1) >> 1u) * select(-side, side, (index & 1) == 1);
}

/// Distance to the cube at that offset, when the nearer border is `border` away. A hair less than the truth: rounding
/// must not leave out a cube.
fn axis_distance(index: i32, border: f32) -> f32 {
    let cells = f32((index + 1) >> 1u);
    let away = select(cells - border, cells - 1.0 + border, (index & 1) == 1);
    return select(max(away - 1e-5, 0.0), 0.0, index == 0);
}
