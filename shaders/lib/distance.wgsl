//! Distance over the surface from a mask: the solution of the eikonal equation, swept until it has gone far enough.
//!
//! Each sweep takes for every texel the shortest way through one of the eight triangles around it, whose corners are
//! neighbors with known distances (Fast Marching's update on acute and obtuse triangles alike, see Kimmel and Sethian 1998),
//! measured by how texels lie on the surface. Distances only ever get shorter, and are never shorter than a way there is.
//!
//! Sweeps cost as many passes as the way has texels, so only the first few are as fine as the maps (`distance_start`, then
//! `distance_sweep` for at least three texels of the coarser level): they find the thinnest line. From their
//! mean the coarser level goes on (`distance_sweep` again), and `distance_known` has the best of both.
//! @use core surface

/// No crossing.
const DISTANCE_NONE: f32 = 1e9;

/// Distance to the border of a mask, where the border passes beside this texel: 0 inside, and `far` elsewhere.
///
/// `inside` is 1, or -1 to measure inward from outside. `far` is a little more than the largest distance that is needed: the
/// smaller it is, the sooner ghosts between known and unknown texels converge.
fn distance_start(source: texture_2d_array<f32>, at: Surface, threshold: f32, inside: f32, far: f32) -> f32 {
    let center = (surface_here(source, at).x - threshold) * inside;
    let metric = surface_metric(at);
    let along_u = distance_crossing(
        center,
        (surface_neighbor(source, at, vec2i(1, 0)).x - threshold) * inside,
        (surface_neighbor(source, at, vec2i(-1, 0)).x - threshold) * inside,
    ) * sqrt(metric.x);
    let along_v = distance_crossing(
        center,
        (surface_neighbor(source, at, vec2i(0, 1)).x - threshold) * inside,
        (surface_neighbor(source, at, vec2i(0, -1)).x - threshold) * inside,
    ) * sqrt(metric.z);
    // The border as a straight line through both crossings.
    let nearest = min(along_u, along_v);
    let both = along_u * along_v / max(sqrt(along_u * along_u + along_v * along_v), 1e-30);
    let beside = select(nearest, both, max(along_u, along_v) < DISTANCE_NONE);
    return select(min(beside, far), 0.0, center >= 0.0);
}

/// Share of a step after which a value below 0 reaches 0 on one of two sides.
fn distance_crossing(center: f32, ahead: f32, behind: f32) -> f32 {
    let most = max(ahead, behind);
    return select(2.0 * DISTANCE_NONE, center / min(center - most, -1e-20), center < 0.0 && most >= 0.0);
}

/// One sweep.
fn distance_sweep(state: texture_2d_array<f32>, at: Surface) -> f32 {
    let own = surface_here(state, at).x;
    let metric = surface_metric(at);
    let east = surface_neighbor(state, at, vec2i(1, 0)).x;
    let west = surface_neighbor(state, at, vec2i(-1, 0)).x;
    let south = surface_neighbor(state, at, vec2i(0, 1)).x;
    let north = surface_neighbor(state, at, vec2i(0, -1)).x;
    // Straight neighbors first, then the four diagonals between them.
    var best = min(min(east, west) + sqrt(metric.x), min(south, north) + sqrt(metric.z));
    best = min(best, distance_corner(surface_neighbor(state, at, vec2i(1, 1)).x, east, south, metric, 1.0));
    best = min(best, distance_corner(surface_neighbor(state, at, vec2i(-1, -1)).x, west, north, metric, 1.0));
    best = min(best, distance_corner(surface_neighbor(state, at, vec2i(1, -1)).x, east, north, metric, -1.0));
    best = min(best, distance_corner(surface_neighbor(state, at, vec2i(-1, 1)).x, west, south, metric, -1.0));
    return min(own, best);
}

/// The finer distance up to `reach`, the coarser one from twice that on.
///
/// `level` holds the width of the coarser texels: where lengths are shares of each piece, they are chosen for the largest
/// one, and small pieces have few of them, or none.
fn distance_known(
    fine: texture_2d_array<f32>, coarse: texture_2d_array<f32>, level: texture_2d_array<f32>, at: Surface, reach: f32,
) -> f32 {
    let near = surface_here(fine, at).x;
    let far = surface_here(coarse, at).x;
    let texel = surface_here(level, at).x;
    let begin = max(reach, texel);
    return mix(near, far, select(0.0, smoothstep(begin, 2.0 * begin, near), texel > 0.0));
}

/// The shortest way by way of a diagonal neighbor and one of the two straight ones beside it. `turn` is the sign of the
/// product of the diagonal's steps.
fn distance_corner(diagonal: f32, along_u: f32, along_v: f32, metric: vec3f, turn: f32) -> f32 {
    let across = metric.y * turn;
    // Vectors to the corners, by their products: u and v are the straight ones, u + v the diagonal.
    let square = metric.x + 2.0 * across + metric.z;
    let over_u = distance_triangle(along_u, diagonal, metric.x, metric.x + across, square);
    let over_v = distance_triangle(along_v, diagonal, metric.z, metric.z + across, square);
    return min(min(over_u, over_v), diagonal + sqrt(square));
}

/// The shortest way through the side between two corners whose distances are known. `aa`, `ab` and `bb` are products of the
/// vectors to them.
fn distance_triangle(to_a: f32, to_b: f32, aa: f32, ab: f32, bb: f32) -> f32 {
    // The way through a + t (b - a) is to_a + t (to_b - to_a) + |a + t (b - a)|: least where its derivative is 0.
    let side = max(aa - 2.0 * ab + bb, 1e-30);
    let change = to_b - to_a;
    let flat = ab - aa;
    let height = max(aa - flat * flat / side, 0.0);
    let slope = change * change;
    // Steeper than the side is long: one of the corners alone is nearer.
    let inside = slope < side;
    let reach = -change * sqrt(height / max(side - slope, 1e-30));
    let t = clamp((reach * sqrt(1.0 / side) - flat / side), 0.0, 1.0);
    let length = sqrt(max(aa + t * (2.0 * flat + t * side), 0.0));
    return select(DISTANCE_NONE, to_a + t * change + length, inside);
}
