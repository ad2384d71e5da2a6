// The tangent-space normal of a material: the model's own slope and the gradient of the height, by the true metric.
//
// Surface gradient after Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"; the frame is MikkTSpace's,
// interpolated without normalizing, as those that decode the map use it.

struct Relief {
    has_height: u32,
    has_slope: u32,
    pad: vec2u,
}

@group(1) @binding(0) var<uniform> relief: Relief;
@group(1) @binding(1) var heights: texture_2d_array<f32>;
@group(1) @binding(2) var slopes: texture_2d_array<f32>;
@group(1) @binding(3) var normals: texture_storage_2d_array<rgba32float, write>;

fn height_at(texel: vec3i) -> f32 {
    return textureLoad(heights, texel.xy, texel.z, 0).x;
}

// Cosine of the angle between shading normals from which on an edge counts as hard.
const HARD_EDGE: f32 = 0.766;

// The shading normal of a triangle at texel coordinates of its chart.
fn normal_at(triangle: u32, point: vec2f) -> vec3f {
    let g = triangle * GEOMETRY_ROWS;
    let step = point - vec2f(geometry_row(g).w, geometry_row(g + 1u).w);
    return unit_or(
        geometry_row(g + 3u).xyz + geometry_row(g + 4u).xyz * step.x + geometry_row(g + 5u).xyz * step.y,
        vec3f(0.0, 1.0, 0.0),
    );
}

// Whether a ghost lies over a hard edge from the triangle that reads it. Heights on both sides of such an edge rise in
// different directions, so a step between them is no slope of either side.
fn is_over_edge(near: vec3i, triangle: u32) -> bool {
    let owner = owner_of(near);
    if owner == EMPTY || (owner & GHOST_BIT) == 0u {
        return false;
    }
    let spot = spot_of(near, owner);
    let own = normal_at(triangle, vec2f(near.xy) + 0.5);
    return dot(own, normal_at(spot.triangle, spot.point)) < HARD_EDGE;
}

// The height next to a texel; over a hard edge what the own side would be, straight on.
fn height_near(center: vec3i, step: vec2i, middle: f32, triangle: u32) -> f32 {
    let near = center + vec3i(step, 0);
    if !is_over_edge(near, triangle) {
        return height_at(near);
    }
    let opposite = center - vec3i(step, 0);
    if is_over_edge(opposite, triangle) {
        return middle;
    }
    return 2.0 * middle - height_at(opposite);
}

// Change of the height a texel along u and v; Scharr's weights, exact for planes.
fn height_steps(center: vec3i, triangle: u32) -> vec2f {
    var steps = vec2f(0.0);
    var ghosts_left = 0u;
    let middle = height_at(center);
    for (var index = 0; index < 9; index++) {
        let near = center + vec3i(step_of(index), 0);
        let owner = owner_of(near);
        let is_ghost = owner != EMPTY && (owner & GHOST_BIT) != 0u;
        ghosts_left |= select(0u, 1u << u32(index), is_ghost);
        steps += select(weight_of(index) * (height_at(near) - middle), vec2f(0.0), is_ghost);
    }
    // Few texels are next to ghosts, and software adapters go through both sides of an `if`, but not through rounds of a
    // loop that no texel at hand takes.
    for (var n = 0; n < 9; n++) {
        if ghosts_left == 0u {
            break;
        }
        let index = i32(firstTrailingBit(ghosts_left));
        ghosts_left &= ghosts_left - 1u;
        steps += weight_of(index) * (height_near(center, step_of(index), middle, triangle) - middle);
    }
    return steps;
}

fn step_of(index: i32) -> vec2i {
    return vec2i(index % 3 - 1, index / 3 - 1);
}

fn weight_of(index: i32) -> vec2f {
    let step = step_of(index);
    return vec2f(step) * select(vec2f(3.0), vec2f(10.0), step.yx == vec2i(0)) / 32.0;
}

// The nearest owned texel within two steps; the texel itself if it is owned. w is 0 if there is none.
fn anchor_of(texel: vec3i) -> vec4i {
    if (owner_of(texel) & GHOST_BIT) == 0u {
        return vec4i(texel, 1);
    }
    let size = vec2i(textureDimensions(owners));
    var best = 1000;
    var anchor = vec4i(texel, 0);
    for (var index = 0; index < 25; index++) {
        let step = vec2i(index % 5 - 2, index / 5 - 2);
        let near = texel + vec3i(step, 0);
        let distance = dot(step, step);
        let is_inside = all(near.xy >= vec2i(0)) && all(near.xy < size);
        if is_inside && distance < best && (owner_of(near) & GHOST_BIT) == 0u {
            best = distance;
            anchor = vec4i(near, 1);
        }
    }
    return anchor;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    if owner_of(texel) == EMPTY {
        return;
    }
    let anchor = anchor_of(texel);
    if anchor.w == 0 {
        return;
    }
    // A ghost continues its own chart's triangle: a smooth edge stays smooth, and a hard one hard.
    let triangle = owner_of(anchor.xyz);
    let g = triangle * GEOMETRY_ROWS;
    let f = triangle * FRAME_ROWS;
    let step = vec2f(texel.xy) + 0.5 - vec2f(geometry_row(g).w, geometry_row(g + 1u).w);
    let along_u = geometry_row(g + 1u).xyz;
    let along_v = geometry_row(g + 2u).xyz;
    let n = geometry_row(g + 3u).xyz + geometry_row(g + 4u).xyz * step.x + geometry_row(g + 5u).xyz * step.y;
    let t = frame_row(f).xyz + frame_row(f + 1u).xyz * step.x + frame_row(f + 2u).xyz * step.y;
    let b = frame_row(f).w * cross(n, t);
    let up = unit_or(n, vec3f(0.0, 1.0, 0.0));

    var slope = vec3f(0.0);
    if relief.has_slope != 0u {
        let stored = textureLoad(slopes, texel.xy, texel.z, 0).xyz;
        slope = stored - up * dot(up, stored);
    }
    if relief.has_height != 0u {
        // In the outer ring the stencil would leave the ghosts, so it is taken one texel further in.
        let inward = anchor.xy - texel.xy;
        var center = texel + vec3i(select(vec2i(0), sign(inward), max(abs(inward.x), abs(inward.y)) > 1), 0);
        if is_over_edge(center, triangle) {
            center = anchor.xyz;
        }
        let change = height_steps(center, triangle);
        let r1 = cross(along_v, up);
        let r2 = cross(up, along_u);
        let determinant = dot(along_u, r1);
        if abs(determinant) > 1e-20 {
            slope += (r1 * change.x + r2 * change.y) / determinant;
        }
    }
    // Cramer's rule for (t b n) x = up - slope; the frame need not be orthonormal. `up` lies along n, so its share is
    // (0, 0, 1 / |n|) without any rounding, and where the slope is none the normal is exactly flat, however skewed the
    // frame. A frame without volume cannot tilt anything.
    let volume = dot(t, cross(b, n));
    let lengths = length(t) * length(b) * length(n);
    var encoded = vec3f(0.0, 0.0, 1.0);
    if any(slope != vec3f(0.0)) && abs(volume) > 1e-6 * lengths {
        let across = vec3f(dot(slope, cross(b, n)), dot(slope, cross(n, t)), dot(slope, cross(t, b))) / volume;
        encoded = unit_or(vec3f(0.0, 0.0, 1.0 / length(n)) - across, encoded);
    }
    textureStore(normals, texel.xy, texel.z, vec4f(encoded, 1.0));
}
