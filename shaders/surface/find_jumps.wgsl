//! Finds whether any ghost of a map lies beyond a jump.
//! @use surface/borders

@group(1) @binding(3) var<storage, read_write> found: array<atomic<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * borders.row_length + group.x) * 64u + local;
    if index < borders.ghost_count && shown_ghost(index).is_changed {
        atomicMax(&found[borders.place], 1u);
    }
}
