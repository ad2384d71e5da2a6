//! The frame of tangent-space maps: MikkTSpace's, interpolated without normalizing, as those that decode the maps use it.
//! @use atlas surface/place

struct TangentFrame {
    tangent: vec3f,
    bitangent: vec3f,
    normal: vec3f,
}

// The frame of a triangle, or of its plane beyond it, at the middle of a texel.
fn tangent_frame_at(triangle: u32, texel: vec3i) -> TangentFrame {
    let g = triangle * GEOMETRY_ROWS;
    return tangent_frame(triangle, vec2f(texel.xy) + 0.5 - vec2f(geometry_row(g).w, geometry_row(g + 1u).w));
}

// The same at a step from the triangle's first corner, in texels.
fn tangent_frame(triangle: u32, step: vec2f) -> TangentFrame {
    let g = triangle * GEOMETRY_ROWS;
    let f = triangle * FRAME_ROWS;
    let normal = geometry_row(g + 3u).xyz + geometry_row(g + 4u).xyz * step.x + geometry_row(g + 5u).xyz * step.y;
    let along_u = frame_row(f + 1u);
    let tangent = frame_row(f).xyz + along_u.xyz * step.x + frame_row(f + 2u).xyz * step.y;
    return TangentFrame(tangent, bitangent_sign_of(along_u.w) * cross(normal, tangent), normal);
}
