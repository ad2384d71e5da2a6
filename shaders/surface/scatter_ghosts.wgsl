// Writes the gathered values to the ghost texels. FORMAT is the storage format of the field.

struct Scatter {
    ghost_count: u32,
    with_ghosts: u32,
    row_length: u32,
    pad: u32,
}

@group(1) @binding(0) var<uniform> scatter: Scatter;
@group(1) @binding(1) var field: texture_storage_2d_array<FORMAT, write>;
@group(1) @binding(2) var<storage, read> values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * scatter.row_length + group.x) * 64u + local;
    if index >= scatter.ghost_count {
        return;
    }
    let link = ghost_link(index);
    let texel = vec2i(i32(link.texel & 0xffffu), i32(link.texel >> 16u));
    textureStore(field, texel, i32(link.page), values[index]);
}
