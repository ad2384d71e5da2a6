// Computes what plain ghost texels hold, those whose point over the seam lies between four owned texels; a table says all
// of it in one row.

struct Gather {
    ghost_count: u32,
    with_ghosts: u32,
    row_length: u32,
    // Rows of the table for a ghost.
    rows: u32,
}

@group(1) @binding(0) var<uniform> gather: Gather;
@group(1) @binding(1) var field: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * gather.row_length + group.x) * 64u + local;
    if index >= gather.ghost_count {
        return;
    }
    let link = fill_link(index * gather.rows);
    let a = textureLoad(field, link.corner, link.page, 0);
    let b = textureLoad(field, link.corner + vec2i(1, 0), link.page, 0);
    let c = textureLoad(field, link.corner + vec2i(0, 1), link.page, 0);
    let d = textureLoad(field, link.corner + vec2i(1, 1), link.page, 0);
    // Around one of them, so that a constant stays what it is, bit by bit.
    let top = (b - a) * link.weight.x;
    let bottom = (c - a) + (d - c) * link.weight.x;
    values[index] = a + top + (bottom - top) * link.weight.y;
}
