//! How a field node reads stored results on the surface.
//!
//! Steps are texels of the texel's own chart. Two texels in any direction are valid everywhere: over a seam the atlas keeps
//! ghost texels, refreshed before each read, that hold the values straight ahead on the other side. `surface_walk` reaches
//! further.
//! @use core atlas
//! @given ON_POINTS

/// The stored value `step` texels away, at most two in each direction.
fn surface_neighbor(source: texture_2d_array<f32>, at: Surface, step: vec2i) -> vec4f {
    return textureLoad(source, at.texel.xy + clamp(step, vec2i(-2), vec2i(2)), at.texel.z, 0);
}

/// Most points that flow to one; it has about six neighbors.
const FLOW_LIMIT: u32 = 64u;

/// Whether this pass runs on points spread over the surface (`@points`): they lie side by side in no order, so
/// `surface_neighbor` reads nothing of use there, and `surface_flow` stands in for it.
fn surface_is_scattered() -> bool {
    return ON_POINTS;
}

/// Flow to a point from those around it: their differences from it, each times how fast it passes. The step that it
/// makes of `state` is the Laplacian, for a time in which a value spreads by the spacing of the points.
fn surface_flow(state: texture_2d_array<f32>, at: Surface) -> f32 {
    let width = textureDimensions(state).x;
    let own = u32(at.texel.y) * width + u32(at.texel.x);
    let center = textureLoad(state, at.texel.xy, 0, 0).x;
    let list = textureLoad(ghosts, table_texel(own), 0);
    var flow = 0.0;
    for (var index = 0u; index < FLOW_LIMIT; index += 2u) {
        if index >= list.y {
            break;
        }
        let pair = textureLoad(ghosts, table_texel(list.x + index / 2u), 0);
        let first = textureLoad(state, vec2u(pair.x % width, pair.x / width), 0, 0).x;
        let second = textureLoad(state, vec2u(pair.z % width, pair.z / width), 0, 0).x;
        // An odd number of them ends with a rate of 0.
        flow += bitcast<f32>(pair.y) * (first - center) + bitcast<f32>(pair.w) * (second - center);
    }
    return flow;
}

/// The stored value at this place.
fn surface_here(source: texture_2d_array<f32>, at: Surface) -> vec4f {
    return textureLoad(source, at.texel.xy, at.texel.z, 0);
}

/// How texels lie on the surface here: squared length of a step along u, product of the two steps, squared length of a
/// step along v; working units. On ghosts along the axes of the chart that reads them.
fn surface_metric(at: Surface) -> vec3f {
    return vec3f(
        dot(at.texel_step, at.texel_step),
        dot(at.texel_step, at.texel_rise),
        dot(at.texel_rise, at.texel_rise),
    );
}

/// The same for the texel `step` away, at most two in each direction; its own where there is none.
fn surface_metric_near(at: Surface, step: vec2i) -> vec3f {
    let texel = vec3i(at.texel.xy + clamp(step, vec2i(-2), vec2i(2)), at.texel.z);
    let owner = owner_of(texel);
    if owner == EMPTY {
        return surface_metric(at);
    }
    let is_ghost = (owner & GHOST_BIT) != 0u;
    let link = ghost_link(select(0u, owner & ~GHOST_BIT, is_ghost));
    let row = select(owner, link.triangle, is_ghost) * GEOMETRY_ROWS;
    let axes = select(vec4f(1.0, 0.0, 0.0, 1.0), link.target_from_own, is_ghost);
    let along_u = geometry_row(row + 1u).xyz;
    let along_v = geometry_row(row + 2u).xyz;
    let across = along_u * axes.x + along_v * axes.y;
    let rise = along_u * axes.z + along_v * axes.w;
    return vec3f(dot(across, across), dot(across, rise), dot(rise, rise));
}

/// Gradient of the stored values, a tangent vector: its product with a short step is the change along the step. Scharr's
/// weights, which measure a slope alike however the texels are rotated.
fn surface_gradient(source: texture_2d_array<f32>, at: Surface) -> vec3f {
    let rise = surface_neighbor(source, at, vec2i(1, 1)).x - surface_neighbor(source, at, vec2i(-1, -1)).x;
    let fall = surface_neighbor(source, at, vec2i(1, -1)).x - surface_neighbor(source, at, vec2i(-1, 1)).x;
    let across = surface_neighbor(source, at, vec2i(1, 0)).x - surface_neighbor(source, at, vec2i(-1, 0)).x;
    let along = surface_neighbor(source, at, vec2i(0, 1)).x - surface_neighbor(source, at, vec2i(0, -1)).x;
    let change = vec2f(3.0 * (rise + fall) + 10.0 * across, 3.0 * (rise - fall) + 10.0 * along) / 32.0;
    return surface_covector(at, change);
}

/// Tangent vector whose product with the texel steps is `change`.
fn surface_covector(at: Surface, change: vec2f) -> vec3f {
    let metric = surface_metric(at);
    let area = metric.x * metric.z - metric.y * metric.y;
    let u = metric.z * change.x - metric.y * change.y;
    let v = metric.x * change.y - metric.y * change.x;
    return select(vec3f(0.0), (at.texel_step * u + at.texel_rise * v) / area, area > 1e-30);
}

/// A place between texels, with the direction and the rest of a walk.
struct Walk {
    /// Texel coordinates on the page; centers lie at halves.
    texel: vec2f,
    page: i32,
    /// Unit direction in which the walk goes on.
    heading: vec3f,
    /// Length that is left: above 0 where the way was too long for one walk.
    left: f32,
}

/// Most iterations of a walk.
const WALK_STEPS: i32 = 128;

/// A walk at the texel's own place, before the first step.
fn surface_standing(at: Surface) -> Walk {
    return Walk(vec2f(at.texel.xy) + 0.5, at.texel.z, vec3f(0.0), 0.0);
}

/// The end of a walk along `way`, a vector in model space, straight over the surface: over seams, and at the border of the
/// model back as from a mirror. The vector's component along the normal is left out.
fn surface_walk(start: Walk, way: vec3f) -> Walk {
    var walk = start;
    walk.left = length(way);
    walk.heading = unit_or(way, vec3f(1.0, 0.0, 0.0));
    // The heading in texels of the current chart, for a step of one working unit.
    var steps = vec2f(0.0);
    for (var index = 0; index < WALK_STEPS; index++) {
        let texel = vec3i(vec2i(floor(walk.texel)), walk.page);
        let owner = owner_of(texel);
        if owner == EMPTY {
            break;
        }
        let is_ghost = (owner & GHOST_BIT) != 0u;
        let link = ghost_link(select(0u, owner & ~GHOST_BIT, is_ghost));
        let triangle = select(owner, link.triangle, is_ghost);
        let row = triangle * GEOMETRY_ROWS;
        let along_u = geometry_row(row + 1u).xyz;
        let along_v = geometry_row(row + 2u).xyz;
        if is_ghost {
            let axes = mat2x2f(link.target_from_own.xy, link.target_from_own.zw);
            walk.texel = link.target_texel + axes * (walk.texel - vec2f(texel.xy) - 0.5);
            walk.page = i32(link.target_page);
            // A walk that starts on a ghost has no steps of its chart yet, and its vector lies over the seam already.
            let carried = axes * steps;
            let ahead = along_u * carried.x + along_v * carried.y;
            walk.heading = unit_or(ahead, walk.heading);
        }
        // Onto the plane of the triangle, without the component across it.
        let up = unit_or(cross(along_u, along_v), vec3f(0.0, 1.0, 0.0));
        walk.heading = unit_or(walk.heading - up * dot(walk.heading, up), walk.heading);
        let metric = vec3f(dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v));
        let area = metric.x * metric.z - metric.y * metric.y;
        let along = vec2f(dot(along_u, walk.heading), dot(along_v, walk.heading));
        let turned = vec2f(metric.z * along.x - metric.y * along.y, metric.x * along.y - metric.y * along.x);
        steps = turned / max(area, 1e-30);
        let leap = select(leap_of(texel), 0.0, is_ghost);
        let reach = max(leap, 1.0) / max(length(steps), 1e-20);
        let stride = min(walk.left, reach);
        walk.texel += steps * stride;
        walk.left -= stride;
        if walk.left <= 0.0 {
            break;
        }
    }
    return surface_landing(walk);
}

/// A walk that ended on a ghost, moved to the other side of the seam.
fn surface_landing(walk: Walk) -> Walk {
    var landed = walk;
    for (var index = 0; index < 2; index++) {
        let texel = vec3i(vec2i(floor(landed.texel)), landed.page);
        let owner = owner_of(texel);
        if owner == EMPTY || (owner & GHOST_BIT) == 0u {
            break;
        }
        let link = ghost_link(owner & ~GHOST_BIT);
        let axes = mat2x2f(link.target_from_own.xy, link.target_from_own.zw);
        landed.texel = link.target_texel + axes * (landed.texel - vec2f(texel.xy) - 0.5);
        landed.page = i32(link.target_page);
    }
    return landed;
}

/// The stored value where a walk ended, interpolated between four texels.
fn surface_sample(source: texture_2d_array<f32>, walk: Walk) -> vec4f {
    let corner = floor(walk.texel - 0.5);
    let weight = walk.texel - 0.5 - corner;
    let texel = vec2i(corner);
    let a = textureLoad(source, texel, walk.page, 0);
    let b = textureLoad(source, texel + vec2i(1, 0), walk.page, 0);
    let c = textureLoad(source, texel + vec2i(0, 1), walk.page, 0);
    let d = textureLoad(source, texel + vec2i(1, 1), walk.page, 0);
    return mix(mix(a, b, weight.x), mix(c, d, weight.x), weight.y);
}
