//! Faces of a cube map, as Vulkan, Direct3D and Metal number and turn them.

/// One pass over all faces of a level.
struct CubePass {
    /// Texels along a side of the target.
    side: u32,
    /// Samples: places along a texel's side, or directions.
    count: u32,
    /// Level of the source to read.
    lod: f32,
    pad: u32,
}

/// The direction, not of unit length, at a place of a face, -1 to 1 from the left and from the top.
fn cube_direction(face: u32, at: vec2f) -> vec3f {
    switch face {
        case 0u: { return vec3f(1.0, -at.y, -at.x); }
        case 1u: { return vec3f(-1.0, -at.y, at.x); }
        case 2u: { return vec3f(at.x, 1.0, at.y); }
        case 3u: { return vec3f(at.x, -1.0, -at.y); }
        case 4u: { return vec3f(at.x, -at.y, 1.0); }
        default: { return vec3f(-at.x, -at.y, -1.0); }
    }
}

/// Mean of a sum of light, by its sum of weights; limited to what a half float holds, since a larger value would be stored
/// as infinity.
fn mean_light(sum: vec4f) -> vec4f {
    return vec4f(min(sum.rgb / sum.a, vec3f(65504.0)), 1.0);
}
