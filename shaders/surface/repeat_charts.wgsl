//! Lets ghosts beyond a jump repeat their own chart, in a copy of the map: the map itself is read by filters, which go on over seams.
//! @use surface/borders
//! @given StoredField

@group(1) @binding(3) var shown: StoredField;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * borders.row_length + group.x) * 64u + local;
    if index >= borders.ghost_count {
        return;
    }
    let ghost = shown_ghost(index);
    textureStore(shown, ghost.texel.xy, ghost.texel.z, ghost.value);
}
