//! Moves along slopes of stored values.
//! @use surface

/// How far a slope moves a place: at most `distance`, which it nears where the source changes by 1 on that way.
fn slope_way(slope: vec3f, distance: f32) -> vec3f {
    let steep = slope * distance;
    return steep * (abs(distance) * inverseSqrt(1.0 + dot(steep, steep)));
}
