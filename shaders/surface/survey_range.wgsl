//! Lowest and highest value of a mask over the surface or each group, as keys that sort like the values.
//! @use atlas surface/place surface/sorted surface/survey_group

@group(1) @binding(0) var<uniform> survey: Survey;
@group(1) @binding(1) var source: texture_2d_array<f32>;
@group(1) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let first = survey_counts_of(owner, survey);
    let value = textureLoad(source, texel.xy, texel.z, 0).x;
    // Reading first avoids nearly all writes to the two values that all invocations of a group share.
    let key = key_of(bitcast<u32>(clamp(value, -1e9, 1e9)));
    if key < atomicLoad(&counts[first]) {
        atomicMin(&counts[first], key);
    }
    if key > atomicLoad(&counts[first + 1u]) {
        atomicMax(&counts[first + 1u], key);
    }
}
