//! Lowest and highest value of a mask over the surface, as keys that sort like the values.
//! @use atlas surface/place surface/sorted

@group(1) @binding(0) var source: texture_2d_array<f32>;
@group(1) @binding(1) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let value = textureLoad(source, texel.xy, texel.z, 0).x;
    // Reading first avoids nearly all writes to the two values that all invocations share.
    let key = key_of(bitcast<u32>(clamp(value, -1e9, 1e9)));
    if key < atomicLoad(&counts[0]) {
        atomicMin(&counts[0], key);
    }
    if key > atomicLoad(&counts[1]) {
        atomicMax(&counts[1], key);
    }
}
