//! Writes the gathered values to plain or coupled ghost texels.
//! @use atlas surface/fill
//! @given StoredField

@group(1) @binding(1) var field: StoredField;
@group(1) @binding(2) var<storage, read> values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * fill.row_length + group.x) * 64u + local;
    if index >= fill.ghost_count {
        return;
    }
    let link = fill_link(index * fill.rows);
    textureStore(field, link.texel, link.own_page, values[index]);
}
