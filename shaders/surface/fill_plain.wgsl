//! Computes plain ghost texels, those whose point over the seam lies between four owned texels; a table describes each in
//! one row. Linked with one of `access_*.wgsl`, which says where texels are read (`field_at`) and where values go (`keep`).
//! @use atlas surface/fill

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * fill.row_length + group.x) * 64u + local;
    if index >= fill.ghost_count {
        return;
    }
    let link = fill_link(index * fill.rows);
    let a = field_at(link.corner, link.page);
    let b = field_at(link.corner + vec2i(1, 0), link.page);
    let c = field_at(link.corner + vec2i(0, 1), link.page);
    let d = field_at(link.corner + vec2i(1, 1), link.page);
    // Differences from one of them, so that a constant keeps its bits.
    let top = (b - a) * link.weight.x;
    let bottom = (c - a) + (d - c) * link.weight.x;
    keep(index, link, a + top + (bottom - top) * link.weight.y);
}
