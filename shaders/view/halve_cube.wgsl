//! The next level of a cube map: each texel is the mean of 16 with the weights 1 3 3 1 along both sides, by the part of the
//! sphere that they cover. A light between two texels is shared by them then and stays where it is; the mean of four would
//! draw it to the middle of one.
//! @use view/cube

@group(0) @binding(0) var<uniform> cube_pass: CubePass;
@group(0) @binding(1) var finer: texture_cube<f32>;
@group(0) @binding(2) var around: sampler;
@group(0) @binding(3) var cube: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(cube_pass.side)) {
        return;
    }
    var sum = vec4f();
    for (var i = 0u; i < 4u; i++) {
        // Between two texels of the finer level, three times as near to the inner one.
        let offset = 0.5 + 0.375 * (2.0 * vec2f(vec2u(i % 2u, i / 2u)) - 1.0);
        let at = (vec2f(id.xy) + offset) / f32(cube_pass.side) * 2.0 - 1.0;
        let weight = pow(1.0 + dot(at, at), -1.5);
        sum += weight * vec4f(textureSampleLevel(finer, around, cube_direction(id.z, at), cube_pass.lod).rgb, 1.0);
    }
    textureStore(cube, id.xy, id.z, mean_light(sum));
}
