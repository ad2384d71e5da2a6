//! Reflections of a rough surface: the light around each direction, weighted by GGX for a view along the normal (Karis 2013,
//! Real Shading in Unreal Engine 4), by few directions that each stand for the light around them (Křivánek and Colbert 2008,
//! Real-time Shading with Filtered Importance Sampling).
//! @use view/cube

@group(0) @binding(0) var<uniform> cube_pass: CubePass;
@group(0) @binding(1) var source: texture_cube<f32>;
@group(0) @binding(2) var around: sampler;
@group(0) @binding(3) var cube: texture_storage_2d_array<rgba16float, write>;
/// Directions of light around +Z, and the level of the source that stands for the light around them.
@group(0) @binding(4) var<storage, read> lobe: array<vec4f>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(cube_pass.side)) {
        return;
    }
    let at = (vec2f(id.xy) + 0.5) / f32(cube_pass.side) * 2.0 - 1.0;
    let normal = normalize(cube_direction(id.z, at));
    // Duff et al. 2017, Building an Orthonormal Basis, Revisited.
    let side = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    let tangent = vec3f(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    let bitangent = vec3f(b, side + normal.y * normal.y * a, -normal.y);
    var sum = vec4f();
    for (var i = 0u; i < cube_pass.count; i++) {
        let to = lobe[i];
        let direction = to.x * tangent + to.y * bitangent + to.z * normal;
        sum += to.z * vec4f(textureSampleLevel(source, around, direction, to.w).rgb, 1.0);
    }
    textureStore(cube, id.xy, id.z, mean_light(sum));
}
