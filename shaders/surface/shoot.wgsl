// Where the rays of a texel start. Appended to kernels that shoot.

// For each quarter of a texel whether one plane lies under it and under the quarter across, so that places in the two have
// the texel's middle as their mean. Bit 0 is the quarter towards lower columns and rows, bit 1 adds a column, bit 2 a row.
fn even_quarters(texel: vec3i, owner: u32, normal: vec3f) -> u32 {
    // Around the texel, from the left and on by eighths of a turn.
    var around = array<vec2i, 8>(
        vec2i(-1, 0), vec2i(-1, -1), vec2i(0, -1), vec2i(1, -1), vec2i(1, 0), vec2i(1, 1), vec2i(0, 1), vec2i(-1, 1),
    );
    var same = 0u;
    for (var eighth = 0u; eighth < 8u; eighth++) {
        let other = owner_of(texel + vec3i(around[eighth], 0));
        let is_same = other == owner || (other & GHOST_BIT) == 0u && dot(face_of(other), normal) > 0.999999;
        same |= select(0u, 1u << eighth, is_same);
    }
    // Half the way around, from the left to the right and on: a quarter is even if its three eighths are.
    same |= same << 8u;
    let corner = same & (same >> 1u) & (same >> 2u);
    let lower = (corner & (corner >> 4u)) & 1u;
    let upper = (corner >> 2u) & (corner >> 6u) & 1u;
    return lower | (lower << 3u) | (upper << 1u) | (upper << 2u);
}

// The place of ray `index` in its texel, so that what changes inside a texel is averaged. Roberts' sequence spreads the
// places of a texel evenly. Over a quarter with several triangles the place stays in the middle: on the plane of one of
// them it would hang above the other or lie below it.
fn jittered(center: Surface, quarters: u32, index: u32) -> Surface {
    let start = pcg3d(vec3u(bitcast<vec2u>(center.texel.xy), bitcast<u32>(center.texel.z) ^ 0x9e3779b9u)).xy;
    let point = start + index * vec2u(3242174889u, 2447445414u);
    let quarter = (point.x >> 31u) | ((point.y >> 31u) << 1u);
    let is_even = ((quarters >> quarter) & 1u) == 1u;
    let away = select(vec2f(0.0), vec2f(point >> vec2u(8u)) * 5.9604645e-8 - 0.5, is_even);
    var at = center;
    at.position += center.texel_step * away.x + center.texel_rise * away.y;
    return at;
}

// A ray's start, lifted off its triangle to the side that the ray goes to: by more than rounding can move it, and by the
// 256th of a texel that the atlas rounds corners to, or a place just beyond the edge of its triangle would lie below the next.
fn lifted(at: Surface, origin: vec3f, direction: vec3f) -> vec3f {
    let side = select(-1.0, 1.0, dot(direction, at.face_normal) >= 0.0);
    let lift = max(dispatch.farthest * 1e-6, at.texel_size / 256.0);
    return origin + at.face_normal * (side * lift);
}
