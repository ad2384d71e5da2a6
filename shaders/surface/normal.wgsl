//! The tangent-space normal of a material: the model's own slope and the gradient of the height, by the true metric.
//!
//! Surface gradient after Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"; the frame is MikkTSpace's,
//! interpolated without normalizing, as those that decode the map use it.
//! @use atlas surface/place surface/stencil_marks surface/tangent_frame

struct Relief {
    has_height: u32,
    has_slope: u32,
    // Page and first row of the map that is written, where that is a band of the atlas.
    first_page: u32,
    first_row: u32,
}

@group(1) @binding(0) var<uniform> relief: Relief;
@group(1) @binding(1) var heights: texture_2d_array<f32>;
@group(1) @binding(2) var slopes: texture_2d_array<f32>;
@group(1) @binding(3) var stencils: texture_2d_array<u32>;
@group(1) @binding(4) var normals: texture_storage_2d_array<rgba32float, write>;

fn height_at(texel: vec3i) -> f32 {
    return textureLoad(heights, texel.xy, texel.z, 0).x;
}

// Change of the height a texel along u and v; Scharr's weights, exact for planes. Over a hard edge a height is extrapolated
// from the texel's own side.
fn height_steps(center: vec3i, marks: u32) -> vec2f {
    var around: array<f32, 9>;
    for (var index = 0; index < 9; index++) {
        around[index] = height_at(center + vec3i(step_of(index), 0));
    }
    let middle = around[4];
    var steps = vec2f(0.0);
    for (var index = 0; index < 9; index++) {
        let is_ghost = (marks & (FIRST_GHOST << u32(index))) != 0u;
        steps += select(weight_of(index) * (around[index] - middle), vec2f(0.0), is_ghost);
    }
    // Software adapters skip a loop that no texel at hand goes through; few texels are next to ghosts.
    let rounds = select(0, 1, (marks & (0x1ffu * FIRST_GHOST)) != 0u);
    for (var round = 0; round < rounds; round++) {
        for (var index = 0; index < 9; index++) {
            let is_ghost = (marks & (FIRST_GHOST << u32(index))) != 0u;
            let is_over = (marks & (FIRST_OVER_EDGE << u32(index))) != 0u;
            let is_opposite_over = (marks & (FIRST_OVER_EDGE << u32(8 - index))) != 0u;
            let straight_on = select(2.0 * middle - around[8 - index], middle, is_opposite_over);
            let height = select(around[index], straight_on, is_over);
            steps += select(vec2f(0.0), weight_of(index) * (height - middle), is_ghost);
        }
    }
    return steps;
}

fn weight_of(index: i32) -> vec2f {
    let step = step_of(index);
    return vec2f(step) * select(vec2f(3.0), vec2f(10.0), step.yx == vec2i(0)) / 32.0;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let marks = textureLoad(stencils, texel.xy, texel.z, 0).x;
    let triangle = owner_of(texel + unpacked_step(marks));
    if texel.x < 0 || triangle == EMPTY || (marks & NO_STENCIL) != 0u {
        return;
    }
    let along_u = geometry_row(triangle * GEOMETRY_ROWS + 1u).xyz;
    let along_v = geometry_row(triangle * GEOMETRY_ROWS + 2u).xyz;
    let frame = tangent_frame_at(triangle, texel);
    let t = frame.tangent;
    let b = frame.bitangent;
    let n = frame.normal;
    let up = unit_or(n, vec3f(0.0, 1.0, 0.0));

    var slope = vec3f(0.0);
    if relief.has_slope != 0u {
        let stored = textureLoad(slopes, texel.xy, texel.z, 0).xyz;
        slope = stored - up * dot(up, stored);
    }
    if relief.has_height != 0u {
        let change = height_steps(texel + unpacked_step(marks >> 6u), marks);
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
    let written = texel - vec3i(0, i32(relief.first_row), i32(relief.first_page));
    textureStore(normals, written.xy, written.z, vec4f(encoded, 1.0));
}
