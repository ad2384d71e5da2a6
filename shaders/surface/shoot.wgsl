//! Starts of the rays of a texel. Linked to kernels that shoot rays.
//! @use core atlas hash

// The place of ray `index` in its texel, so that changes inside a texel are averaged. Roberts' sequence spreads the
// places of a texel evenly. Where a quarter or the one across it has triangles of several planes, the place stays in the
// middle: on the plane of one of them it would hang above the other or lie below it.
fn jittered(center: Surface, planes: u32, index: u32) -> Surface {
    let start = pcg3d(vec3u(bitcast<vec2u>(center.texel.xy), bitcast<u32>(center.texel.z) ^ 0x9e3779b9u)).xy;
    let point = start + index * vec2u(3242174889u, 2447445414u);
    // Both halves lower or both higher, or one of each.
    let quarters = select(2u, 1u, (point.x >> 31u) == (point.y >> 31u));
    let away = select(vec2f(0.0), vec2f(point >> vec2u(8u)) * 5.9604645e-8 - 0.5, (planes & quarters) != 0u);
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
