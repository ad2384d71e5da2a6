//! How much a normal faces one way.

/// 1 where the normal points exactly that way, 0 from `reach` on; `fade` is the outer share of the reach over which it fades.
/// No way at all selects nothing.
fn facing(normal: vec3f, way: vec3f, reach: f32, fade: f32) -> f32 {
    let size = length(way);
    let toward = way / max(size, 1e-12);
    // The angle by half the chord: exact for small angles, where the arc cosine of a rounded product is not.
    let angle = 2.0 * asin(min(0.5 * length(normal - toward), 1.0));
    let t = clamp((reach - angle) / max(reach * fade, 1e-4), 0.0, 1.0);
    return select(0.0, t * t * (3.0 - 2.0 * t), size > 1e-6);
}
