//! Points scattered through space, one in each cube: the nearest of them, and the walls between their cells.
//!
//! Places and distances are in cubes, in the noise's own space.
//! @use noise

/// The point nearest to a place.
struct NearestPoint {
    /// How far it is.
    distance: f32,
    /// No other point is nearer than this.
    others: f32,
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

/// The 27 cubes around a place as nine rows of three along x, for processors to work on three at a time, without branches.
struct CubeRows {
    cell: vec3i,
    /// The place in its own cube.
    inside: vec3f,
    /// Toward the nearer row of each axis.
    side: vec3i,
    /// How far the nearer border of each axis is.
    border: vec3f,
    /// The columns' part of the hash.
    columns: vec3u,
    /// The other rows are further away than the square root of this: from the fifth row on, from the seventh on, and all
    /// other cubes.
    rest: vec3f,
}

/// From a place to the points of three cubes: the x, y and z of all three.
struct PointRow {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

fn rows_around(place: vec3f, key: vec3u) -> CubeRows {
    let cell = cell_of(place);
    let inside = place - vec3f(cell);
    let border = min(inside, 1.0 - inside);
    // A hair less than the truth: rounding must not leave out a cube.
    let near = max(border - 1e-5, vec3f(0.0));
    let far = 1.0 - 1e-5 - border;
    let nears = near * near;
    let fars = far * far;
    let outside = 1.0 + min(near.x, min(near.y, near.z));
    let rest = vec3f(min(fars.y, fars.z), min(fars.y + nears.z, fars.z + nears.y), outside * outside);
    let columns = ((bitcast<vec3u>(vec3i(-1, 0, 1) + cell.x) & vec3u(65535u)) + key.x) * 1664525u + 1013904223u;
    return CubeRows(cell, inside, select(vec3i(-1), vec3i(1), inside > vec3f(0.5)), border, columns, rest);
}

/// Where row `index` of nine is: y and z, in cubes. The four nearest rows come first.
fn row_step(rows: CubeRows, index: i32) -> vec2i {
    // Two bits for each row: 0 away from the nearer one, 1 here, 2 toward it.
    return ((vec2i(0x8499, 0x21a5) >> vec2u(2u * u32(index)) & vec2i(3)) - 1) * rows.side.yz;
}

/// Whether all points from row `index` on are further away than `reach`, a square.
fn rows_done(rows: CubeRows, index: i32, reach: f32) -> bool {
    return index > 3 && reach <= select(rows.rest.x, rows.rest.y, index > 5);
}

/// Random numbers of three cubes: the first, second and third of each.
struct NumberRow {
    x: vec3u,
    y: vec3u,
    z: vec3u,
}

/// The numbers of the row that is `step` away along y and z, the same as those of `cell_random`.
fn number_row(rows: CubeRows, step: vec2i, key: vec3u) -> NumberRow {
    let cell = bitcast<vec2u>(rows.cell.yz + step) & vec2u(65535u);
    let lines = (cell + key.yz) * 1664525u + 1013904223u;
    var x = rows.columns;
    var y = vec3u(lines.x);
    var z = vec3u(lines.y);
    x += y * z;
    y += z * x;
    z += x * y;
    x ^= x >> vec3u(16u);
    y ^= y >> vec3u(16u);
    z ^= z >> vec3u(16u);
    x += y * z;
    y += z * x;
    z += x * y;
    return NumberRow(x, y, z);
}

/// The points of row `index`.
fn point_row(rows: CubeRows, index: i32, jitter: f32, key: vec3u) -> PointRow {
    let step = row_step(rows, index);
    let numbers = number_row(rows, step, key);
    let corner = 0.5 - 0.5 * jitter - rows.inside;
    return PointRow(
        (corner.x + vec3f(-1.0, 0.0, 1.0)) + jitter * unit_random3(numbers.x),
        (corner.y + f32(step.x)) + jitter * unit_random3(numbers.y),
        (corner.z + f32(step.y)) + jitter * unit_random3(numbers.z),
    );
}

/// The nearest point, and how far the others are at least; that is exact if it is at most `margin` further.
///
/// Exact: no point outside of the 27 cubes around is nearer than a cube and the distance to the nearest border of the
/// place's own one. Where that does not settle it, which is rare, the 125 cubes around are looked at; the own cube's point
/// is less than two cubes away.
fn nearest_point(place: vec3f, jitter: f32, key: vec3u, margin: f32) -> NearestPoint {
    let rows = rows_around(place, key);
    var nearest = 16.0;
    var second = 16.0;
    var found = 0;
    var others = rows.rest.z;
    for (var index = 0; index < 9; index++) {
        let reach = sqrt(nearest) + margin;
        if rows_done(rows, index, reach * reach) {
            others = rows.rest.x;
            break;
        }
        let points = point_row(rows, index, jitter, key);
        let squares = points.x * points.x + points.y * points.y + points.z * points.z;
        let least = min(squares.x, min(squares.y, squares.z));
        let middle = max(min(squares.x, squares.y), min(max(squares.x, squares.y), squares.z));
        second = min(min(second, middle), max(nearest, least));
        let column = select(select(2, 1, squares.y == least), 0, squares.x == least);
        found = select(found, 4 * index + column, least < nearest);
        nearest = min(nearest, least);
    }
    var step = vec3i((found & 3) - 1, row_step(rows, found >> 2u));
    if nearest > rows.rest.z {
        step = nearest_of_125(rows, jitter, key);
    }
    let random = cell_random(rows.cell + step, key);
    let offset = vec3f(step) + cell_point(random, jitter) - rows.inside;
    return NearestPoint(length(offset), sqrt(min(second, others)), random.x, offset);
}

/// The step to the cube with the nearest point.
fn nearest_of_125(rows: CubeRows, jitter: f32, key: vec3u) -> vec3i {
    var walk = CubeWalk(vec3i(0), true);
    var found = vec3i(0);
    var nearest = 16.0;
    for (var n = 0; n < 160; n++) {
        let cube = cube_at(walk, rows.side, rows.border);
        walk = next_cube(walk, 5, cube.distance < nearest);
        if !walk.goes_on {
            break;
        }
        let offset = vec3f(cube.step) + cell_point(cell_random(rows.cell + cube.step, key), jitter) - rows.inside;
        let square = dot(offset, offset);
        found = select(found, cube.step, square < nearest);
        nearest = min(nearest, square);
    }
    return found;
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
    let rows = rows_around(place, key);
    let own = nearest.offset;
    var least = reach;
    var steep = vec3f(0.0);
    for (var index = 0; index < 9; index++) {
        // The plane between the nearest point and one at the distance d is at least (d - nearest) / 2 away.
        let limit = nearest.distance + 2.0 * least / finest;
        if rows_done(rows, index, limit * limit) {
            break;
        }
        let points = point_row(rows, index, jitter, key);
        let x = points.x - own.x;
        let y = points.y - own.y;
        let z = points.z - own.z;
        let squares = x * x + y * y + z * z;
        let rise = x * (normal.x / stretch.x) + y * (normal.y / stretch.y) + z * (normal.z / stretch.z);
        let whole = x * x / (stretch.x * stretch.x) + y * y / (stretch.y * stretch.y) + z * z / (stretch.z * stretch.z);
        let along = max(whole - rise * rise, 0.04 * whole);
        let middle = x * (points.x + own.x) + y * (points.y + own.y) + z * (points.z + own.z);
        // The point itself makes no wall.
        let away = select(
            vec3f(1e9), max(0.5 * middle * inverseSqrt(max(along, vec3f(1e-30))), vec3f(0.0)), squares > vec3f(1e-12));
        let nearer = min(away.x, min(away.y, away.z));
        let first = away.x == nearer;
        let between = select(
            select(vec3f(x.z, y.z, z.z), vec3f(x.y, y.y, z.y), away.y == nearer), vec3f(x.x, y.x, z.x), first);
        steep = select(steep, between, nearer < least);
        least = min(least, nearer);
    }
    steep /= stretch;
    var wall = Wall(least, select(steep - dot(steep, normal) * normal, normal.zxy, least == reach));
    let limit = nearest.distance + 2.0 * least / finest;
    if limit * limit > rows.rest.z {
        wall = nearest_wall_of_343(rows, nearest, wall, jitter, key, stretch, normal);
    }
    return wall;
}

/// The nearest wall if it is nearer than one that is known, else that one.
fn nearest_wall_of_343(
    rows: CubeRows, nearest: NearestPoint, known: Wall, jitter: f32, key: vec3u, stretch: vec3f, normal: vec3f,
) -> Wall {
    let finest = finest_stretch(stretch);
    var walk = CubeWalk(vec3i(0), true);
    var least = known;
    for (var n = 0; n < 400; n++) {
        let limit = nearest.distance + 2.0 * least.distance / finest;
        let cube = cube_at(walk, rows.side, rows.border);
        walk = next_cube(walk, 7, cube.distance < limit * limit);
        if !walk.goes_on {
            break;
        }
        let offset = vec3f(cube.step) + cell_point(cell_random(rows.cell + cube.step, key), jitter) - rows.inside;
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
    }
    return least;
}

/// A way through the cubes around a place, those of each axis in the order of their distance, the place's own one first.
/// As one loop for three axes, since processors go through all loops for all places that they work on at once.
struct CubeWalk {
    /// How many cubes were passed along each axis.
    passed: vec3i,
    goes_on: bool,
}

/// A cube that a walk comes to.
struct Cube {
    step: vec3i,
    /// The least that its distance from the place can be, squared.
    distance: f32,
}

/// The cube that a walk is at, for a place whose nearer borders are `border` away toward `side`.
fn cube_at(walk: CubeWalk, side: vec3i, border: vec3f) -> Cube {
    // Offsets by rising distance: 0, side, -side, 2 side, -2 side.
    let cubes = (walk.passed + 1) >> vec3u(1u);
    let toward = (walk.passed & vec3i(1)) == vec3i(1);
    let apart = vec3f(cubes) - select(border, 1.0 - border, toward);
    // A hair less than the truth: rounding must not leave out a cube.
    let distance = select(max(apart - 1e-5, vec3f(0.0)), vec3f(0.0), walk.passed == vec3i(0));
    return Cube(cubes * select(-side, side, toward), dot(distance, distance));
}

/// The walk to the next cube, of `count` along each axis. Where the one it is at is not `near` enough to matter, none behind
/// it is.
fn next_cube(walk: CubeWalk, count: i32, near: bool) -> CubeWalk {
    let at = walk.passed;
    let row_ends = !near || at.x + 1 == count;
    let layer_ends = row_ends && (at.y + 1 == count || (!near && at.x == 0));
    let next = select(vec3i(at.x + 1, at.yz), select(vec3i(0, at.y + 1, at.z), vec3i(0, 0, at.z + 1), layer_ends), row_ends);
    return CubeWalk(next, at.z < count && (near || at.x + at.y > 0));
}
