//! Texels that the slope of a height is taken over, for each texel, and which of them lie over seams and hard edges. They
//! depend on the surface alone, so they are found once for all heights; and only for tiles with ghosts near, since elsewhere all marks
//! are 0.
//! @use atlas surface/place surface/stencil_marks

@group(1) @binding(0) var stencils: texture_storage_2d_array<r32uint, write>;

// Few texels are ghosts or next to some. Software adapters go through both sides of an `if`, but not through rounds of a loop that no
// texel at hand takes: what ghosts need stands in loops.

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

fn is_ghost(texel: vec3i) -> bool {
    let owner = owner_of(texel);
    return owner != EMPTY && (owner & GHOST_BIT) != 0u;
}

// Whether a ghost lies over a hard edge from the triangle that reads it. Heights on both sides of such an edge rise in
// different directions, so a step between them is no slope of either side.
fn is_over_edge(near: vec3i, triangle: u32) -> bool {
    let spot = spot_of(near, owner_of(near));
    let own = normal_at(triangle, vec2f(near.xy) + 0.5);
    return dot(own, normal_at(spot.triangle, spot.point)) < HARD_EDGE;
}

// The nearest owned texel within two steps; the texel itself if it is owned. w is 0 if there is none.
fn anchor_of(texel: vec3i) -> vec4i {
    let size = vec2i(textureDimensions(owners));
    let looked_at = select(0, 25, is_ghost(texel));
    var best = 1000;
    var anchor = vec4i(texel, select(1, 0, is_ghost(texel)));
    for (var index = 0; index < looked_at; index++) {
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

// A step of up to two texels each way.
fn packed_step(step: vec2i) -> u32 {
    let parts = bitcast<vec2u>(step) & vec2u(7u);
    return parts.x | (parts.y << 3u);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    if owner_of(texel) == EMPTY {
        return;
    }
    let anchor = anchor_of(texel);
    if anchor.w == 0 {
        textureStore(stencils, texel.xy, texel.z, vec4u(NO_STENCIL, 0u, 0u, 0u));
        return;
    }
    // A ghost continues its own chart's triangle: a smooth edge stays smooth, and a hard one hard.
    let triangle = owner_of(anchor.xyz);
    // In the outer ring the stencil would leave the ghosts, so it is taken one texel further in.
    let inward = anchor.xy - texel.xy;
    var center = texel + vec3i(select(vec2i(0), sign(inward), max(abs(inward.x), abs(inward.y)) > 1), 0);
    let ghosts = select(0, 1, is_ghost(center));
    for (var n = 0; n < ghosts; n++) {
        center = select(center, anchor.xyz, is_over_edge(center, triangle));
    }
    var marks = packed_step(inward) | (packed_step(center.xy - texel.xy) << 6u);
    for (var index = 0; index < 9; index++) {
        let near = center + vec3i(step_of(index), 0);
        marks |= select(0u, FIRST_GHOST << u32(index), is_ghost(near));
    }
    var ghosts_left = (marks / FIRST_GHOST) & 0x1ffu;
    for (var n = 0; n < 9; n++) {
        if ghosts_left == 0u {
            break;
        }
        let index = firstTrailingBit(ghosts_left);
        ghosts_left &= ghosts_left - 1u;
        let near = center + vec3i(step_of(i32(index)), 0);
        marks |= select(0u, FIRST_OVER_EDGE << index, is_over_edge(near, triangle));
    }
    textureStore(stencils, texel.xy, texel.z, vec4u(marks, 0u, 0u, 0u));
}
