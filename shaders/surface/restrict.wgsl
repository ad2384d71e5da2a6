//! Brings a plane to a coarser level: the mean of the finer texels of the same chart that a texel covers.
//! @use atlas surface/place surface/level
//! @given StoredField

@group(1) @binding(1) var fine_owners: texture_2d_array<u32>;
@group(1) @binding(2) var fine_frames: texture_2d<u32>;
@group(1) @binding(3) var fine: texture_2d_array<f32>;
@group(1) @binding(4) var coarse: StoredField;

fn fine_frame(row: u32) -> vec4u {
    return textureLoad(fine_frames, table_texel(row), 0);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let row = owner * FRAME_ROWS;
    let place = frame_row(row + 3u);
    let fine_place = fine_frame(row + 3u);
    let fine_page = page_of_row(fine_frame(row + 1u).w);
    let corner = (texel.xy - vec2i(place.xy)) * i32(scale.factor) + vec2i(bitcast<vec2f>(fine_place.xy));
    let size = vec2i(textureDimensions(fine_owners));
    var first = vec4f(0.0);
    var sum = vec4f(0.0);
    var count = 0.0;
    for (var y = 0; y < i32(scale.factor); y++) {
        for (var x = 0; x < i32(scale.factor); x++) {
            let near = corner + vec2i(x, y);
            if any(near < vec2i(0)) || any(near >= size) {
                continue;
            }
            let other = textureLoad(fine_owners, near, fine_page, 0).r;
            // EMPTY has the bit of ghosts, too.
            let is_owned = (other & GHOST_BIT) == 0u;
            let chart = fine_frame(select(owner, other, is_owned) * FRAME_ROWS + 3u).z;
            let counts = is_owned && chart == fine_place.z;
            let value = textureLoad(fine, near, fine_page, 0);
            // Differences from the first one, so that a constant keeps its bits.
            first = select(first, value, counts && count == 0.0);
            sum += select(vec4f(0.0), value - first, counts);
            count += select(0.0, 1.0, counts);
        }
    }
    textureStore(coarse, texel.xy, texel.z, first + sum / max(count, 1.0));
}
