// The next level of a cube map: each texel is the mean of four, by the part of the sphere that they cover.

@group(0) @binding(0) var<uniform> pass_: Pass;
@group(0) @binding(1) var finer: texture_2d_array<f32>;
@group(0) @binding(2) var unused: sampler;
@group(0) @binding(3) var cube: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(pass_.side)) {
        return;
    }
    var sum = vec4f();
    for (var i = 0u; i < 4u; i++) {
        let texel = 2u * id.xy + vec2u(i % 2u, i / 2u);
        let at = (vec2f(texel) + 0.5) / f32(pass_.side) - 1.0;
        let weight = pow(1.0 + dot(at, at), -1.5);
        sum += weight * vec4f(textureLoad(finer, texel, id.z, 0).rgb, 1.0);
    }
    textureStore(cube, id.xy, id.z, mean_light(sum));
}
