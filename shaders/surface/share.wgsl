//! Gives texels that share a place on the maps the value that the maps have there: the mean of a group's sources, at all of
//! its targets. Sources are read from the original, so that no group sees the result of another.
//! @use atlas
//! @given StoredField

struct Share {
    group_count: u32,
    row_length: u32,
    // Whether values are unit vectors, whose mean is shorter than one.
    has_unit_vectors: u32,
    pad: u32,
}

@group(1) @binding(0) var<uniform> share: Share;
// Where the texels of each group begin: the number of its sources, these, and its targets.
@group(1) @binding(1) var<storage, read> starts: array<u32>;
// Texels page by page and row by row.
@group(1) @binding(2) var<storage, read> texels: array<u32>;
@group(1) @binding(3) var field: texture_2d_array<f32>;
@group(1) @binding(4) var shown: StoredField;

// Column, row and page.
fn unpacked_texel(index: u32) -> vec3i {
    let size = textureDimensions(field);
    let line = index / size.x;
    return vec3i(vec3u(index % size.x, line % size.y, line / size.y));
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * share.row_length + group.x) * 64u + local;
    if index >= share.group_count {
        return;
    }
    let first = starts[index] + 1u;
    let count = texels[first - 1u];
    var value = vec4f(0.0);
    for (var at = first; at < first + count; at += 1u) {
        let source = unpacked_texel(texels[at]);
        let more = textureLoad(field, source.xy, source.z, 0);
        // A single source keeps its bits.
        value = select(value + more, more, at == first);
    }
    if count > 1u {
        value /= f32(count);
        if share.has_unit_vectors != 0u {
            value = vec4f(unit_or(value.xyz, value.xyz), value.w);
        }
    }
    for (var at = first + count; at < starts[index + 1u]; at += 1u) {
        let place = unpacked_texel(texels[at]);
        textureStore(shown, place.xy, place.z, value);
    }
}
