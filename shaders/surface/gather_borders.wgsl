//! Gathers the values that maps show for ghosts: beyond a jump, that of their own chart. `scatter_ghosts.wgsl` writes them.
//! @use surface/borders

@group(1) @binding(3) var<storage, read_write> values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * borders.row_length + group.x) * 64u + local;
    if index < borders.ghost_count {
        values[index] = shown_ghost(index).value;
    }
}
