//! Types that every node may use: the place that it is evaluated at, and the material.

/// A place on the surface. Lengths are in working units: model units after fitting.
struct Surface {
    /// Position in model space.
    position: vec3f,
    /// Width of a texel here.
    texel_size: f32,
    /// Shading normal, unit length.
    normal: vec3f,
    /// Number of the UV chart.
    chart: u32,
    /// Normal of the triangle, unit length.
    face_normal: vec3f,
    /// Number of the part of the model, an object of its file.
    part: u32,
    /// Direction of growing u along the surface, unit length; `w` of MikkTSpace in `tangent.w`.
    tangent: vec4f,
    /// Texture coordinates that maps are laid out by: the model's own of the chosen set, or of the sheet it was unwrapped to.
    uv: vec2f,
    /// A random number for each piece.
    seed: u32,
    /// Number of the model's material.
    material: u32,
    /// The place in the piece's own box: from its middle, x along its longest side, z along its shortest.
    piece_position: vec3f,
    /// Size of the piece: the side of a cube with the volume of its box.
    piece_size: f32,
    /// Number of the piece: a connected component of a part, such as one plank of a bench.
    piece: u32,
    /// Normal of the triangle along the sides of that box, unit length.
    piece_normal: vec3f,
    /// From a texel to the next one along u, on the surface.
    texel_step: vec3f,
    /// From a texel to the next one along v, on the surface.
    texel_rise: vec3f,
    /// Texel of the atlas: x, y, page. Only `lib/surface` reads it.
    texel: vec3i,
}

/// Number of a repetition of a function, and the width of texels.
struct Round {
    /// From 0.
    index: u32,
    /// Repetitions in all.
    count: u32,
    /// Width of the finest texels of the level that the function runs on, and of the finest level. A few texels may be
    /// finer still, where a model stretches its UVs unevenly.
    texel: f32,
    finest: f32,
}

/// A physically based material at one place, in linear light.
struct Material {
    base_color: vec3f,
    alpha: f32,
    roughness: f32,
    metallic: f32,
    /// 1 is open, 0 is fully occluded.
    occlusion: f32,
    /// Relief above the model, working units.
    height: f32,
    /// Gradient of the relief that the model's normal map describes, a tangent vector in model space.
    slope: vec3f,
    emission: vec3f,
    /// Share of the surface below a clear coat, and how rough that coat is.
    coat: f32,
    coat_roughness: f32,
    /// Direction of fine scratches or fibers, a tangent vector in model space, with its strength, 0..1, as its length.
    /// Highlights are drawn out across it.
    anisotropy: vec3f,
    /// Color of the soft light that fibers and dust scatter at grazing angles, and how far it reaches from there.
    sheen: vec3f,
    sheen_roughness: f32,
    /// Share of the light that spreads below the surface before it comes out again, for each of red, green and blue.
    subsurface: vec3f,
    /// Share of the light that goes through, as through thin glass, instead of being scattered.
    transmission: f32,
}

/// The plain gray material; exports and the viewport use its values for channels that nothing sets.
const PLAIN_MATERIAL = Material(
    vec3f(0.214), 1.0, 0.7, 0.0, 1.0, 0.0, vec3f(0.0), vec3f(0.0),
    0.0, 0.0, vec3f(0.0), vec3f(0.0), 0.0, vec3f(0.0), 0.0,
);

/// The material of an unconnected input: plain gray.
fn plain_material() -> Material {
    return PLAIN_MATERIAL;
}

/// Luminance of a linear color (Rec. 709 primaries).
fn luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}
