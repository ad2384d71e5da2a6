//! The environment behind the model.
//! @use view/frame view/panorama

@group(1) @binding(0) var panorama: texture_2d<f32>;
// Wraps around the seam of the panorama.
@group(1) @binding(1) var round_sampler: sampler;

struct Behind {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn cover(@builtin(vertex_index) index: u32) -> Behind {
    let at = vec2f(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
    return Behind(vec4f(at, 0.0, 1.0), at);
}

@fragment
fn paint(behind: Behind) -> @location(0) vec4f {
    let light = textureSampleLevel(panorama, round_sampler, panorama_place(towards_behind(behind)), 0.0).xyz;
    return shown_behind(light);
}

@fragment
fn paint_blurred(behind: Behind) -> @location(0) vec4f {
    return shown_behind(textureSampleLevel(reflections, smooth_sampler, towards_behind(behind), frame.blur).xyz);
}

fn towards_behind(behind: Behind) -> vec3f {
    let near = frame.view_from_clip * vec4f(behind.at, 1.0, 1.0);
    return in_environment(ray_through(near.xyz / near.w));
}

fn shown_behind(light: vec3f) -> vec4f {
    return vec4f(min(light * frame.environment.z, vec3f(65504.0)), 1.0);
}
