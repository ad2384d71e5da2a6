//! Computes ghost texels once more, with cubics instead of straight lines: slopes that are taken over a seam are then as
//! good as beside it. Ghosts hold what straight lines give; where a cubic would need a texel outside of the atlas, that
//! stays.
//! @use atlas surface/fill

@group(1) @binding(1) var field: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> values: array<vec4f>;

// Lagrange's weights of four texels in a row for a place between the two in the middle: exact for cubics.
fn cubic_weights(t: f32) -> vec4f {
    return vec4f(
        -t * (t - 1.0) * (t - 2.0) / 6.0,
        (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0,
        (t + 1.0) * t * (t - 1.0) / 6.0,
    );
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * fill.row_length + group.x) * 64u + local;
    if index >= fill.ghost_count {
        return;
    }
    let link = ghost_link(index);
    let read = ghost_read(index);
    let page = i32(read.page);
    let corner = floor(read.texel - 0.5);
    let along = cubic_weights(read.texel.x - 0.5 - corner.x);
    let down = cubic_weights(read.texel.y - 0.5 - corner.y);
    let middle = textureLoad(field, vec2i(corner), page, 0);
    let size = vec2i(textureDimensions(owners));
    var sum = vec4f(0.0);
    var low = middle;
    var high = middle;
    var is_known = true;
    for (var tap = 0u; tap < 16u; tap++) {
        let step = vec2u(tap & 3u, tap >> 2u);
        let texel = vec2i(corner) + vec2i(step) - 1;
        let is_inside = all(texel >= vec2i(0)) && all(texel < size);
        let near = clamp(texel, vec2i(0), size - 1);
        is_known = is_known && is_inside && owner_of(vec3i(near, page)) != EMPTY;
        let value = textureLoad(field, near, page, 0);
        // Differences, so that a constant keeps its bits.
        sum += along[step.x] * down[step.y] * (value - middle);
        low = min(low, value);
        high = max(high, value);
    }
    let own = vec2i(i32(link.texel & 0xffffu), i32(link.texel >> 16u));
    let stays = textureLoad(field, own, i32(link.page), 0);
    // Next to a step a cubic overshoots its neighbors: a mask would leave its range.
    let refined = clamp(middle + sum, low, high);
    values[index] = select(stays, refined, is_known);
}
