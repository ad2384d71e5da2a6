//! Brings a plane to the finest level: interpolated between the coarser texels of the same chart.
//! @use atlas surface/place surface/level
//! @given StoredField

// Chart of each coarser texel, or of the ring that it is in.
@group(1) @binding(1) var coarse_charts: texture_2d_array<u32>;
@group(1) @binding(2) var coarse_frames: texture_2d<u32>;
@group(1) @binding(3) var coarse: texture_2d_array<f32>;
@group(1) @binding(4) var fine: StoredField;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let texel = texel_of(group, local);
    let owner = owner_of(texel);
    if owner == EMPTY || (owner & GHOST_BIT) != 0u {
        return;
    }
    let row = owner * FRAME_ROWS;
    let place = frame_row(row + 3u);
    let coarse_place = textureLoad(coarse_frames, table_texel(row + 3u), 0);
    let coarse_page = page_of_row(textureLoad(coarse_frames, table_texel(row + 1u), 0).w);
    let in_chart = (vec2f(texel.xy) + 0.5 - place.xy) / f32(scale.factor);
    let point = in_chart + bitcast<vec2f>(coarse_place.xy) - 0.5;
    let corner = floor(point);
    let weight = point - corner;
    let size = vec2i(textureDimensions(coarse_charts));
    var nearest = vec4f(0.0);
    var nearest_share = 0.0;
    var taps: array<vec4f, 4>;
    var shares: array<f32, 4>;
    for (var tap = 0u; tap < 4u; tap++) {
        let step = vec2i(i32(tap & 1u), i32(tap >> 1u));
        let near = clamp(vec2i(corner) + step, vec2i(0), size - 1);
        let along = select(1.0 - weight, weight, step == vec2i(1));
        let counts = textureLoad(coarse_charts, near, coarse_page, 0).r == coarse_place.z;
        let share = select(0.0, along.x * along.y, counts);
        let value = textureLoad(coarse, near, coarse_page, 0);
        taps[tap] = value;
        shares[tap] = share;
        if share > nearest_share {
            nearest_share = share;
            nearest = value;
        }
    }
    // Differences from the nearest tap, so that a constant keeps its bits.
    var sum = vec4f(0.0);
    var total = 0.0;
    for (var tap = 0u; tap < 4u; tap++) {
        sum += shares[tap] * select(vec4f(0.0), taps[tap] - nearest, shares[tap] > 0.0);
        total += shares[tap];
    }
    textureStore(fine, texel.xy, texel.z, nearest + sum / max(total, 1e-6));
}
