//! A cube map of a panorama: each texel is the mean over a grid of places in it.
//! @use view/cube view/panorama

@group(0) @binding(0) var<uniform> cube_pass: CubePass;
@group(0) @binding(1) var panorama: texture_2d<f32>;
@group(0) @binding(2) var around: sampler;
@group(0) @binding(3) var cube: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(cube_pass.side)) {
        return;
    }
    var sum = vec4f();
    for (var i = 0u; i < cube_pass.count * cube_pass.count; i++) {
        let inside = (vec2f(vec2u(i % cube_pass.count, i / cube_pass.count)) + 0.5) / f32(cube_pass.count);
        let at = (vec2f(id.xy) + inside) / f32(cube_pass.side) * 2.0 - 1.0;
        // Towards the corners of a face, the same square covers less of the sphere.
        let weight = pow(1.0 + dot(at, at), -1.5);
        let place = panorama_place(cube_direction(id.z, at));
        sum += weight * vec4f(textureSampleLevel(panorama, around, place, cube_pass.lod).rgb, 1.0);
    }
    textureStore(cube, id.xy, id.z, mean_light(sum));
}
