// A cube map of a panorama: each texel is the mean over a grid of places in it.

@group(0) @binding(0) var<uniform> pass_: Pass;
@group(0) @binding(1) var panorama: texture_2d<f32>;
@group(0) @binding(2) var around: sampler;
@group(0) @binding(3) var cube: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(pass_.side)) {
        return;
    }
    var sum = vec4f();
    for (var i = 0u; i < pass_.count * pass_.count; i++) {
        let inside = (vec2f(vec2u(i % pass_.count, i / pass_.count)) + 0.5) / f32(pass_.count);
        let at = (vec2f(id.xy) + inside) / f32(pass_.side) * 2.0 - 1.0;
        // Towards the corners of a face, the same square covers less of the sphere.
        let weight = pow(1.0 + dot(at, at), -1.5);
        let place = panorama_place(cube_direction(id.z, at));
        sum += weight * vec4f(textureSampleLevel(panorama, around, place, pass_.lod).rgb, 1.0);
    }
    textureStore(cube, id.xy, id.z, mean_light(sum));
}
