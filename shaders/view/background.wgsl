//! The picture behind the model: a backdrop or the environment, and the shade of the model on the ground.
//! @use view/frame view/ground view/panorama

@group(1) @binding(0) var panorama: texture_2d<f32>;
// Wraps around the seam of the panorama.
@group(1) @binding(1) var round_sampler: sampler;

// Backdrops. Nothing is painted behind a clear picture but the shade on the ground.
const ENVIRONMENT: u32 = 0u;
const BLURRED: u32 = 1u;
const STUDIO: u32 = 2u;
const NOTHING: u32 = 3u;

// Backdrop of the pipeline; see `switches.wgsl` for why it is no uniform.
override BACKDROP: u32 = ENVIRONMENT;
// 1 where the ground shows the shade of the model.
override GROUND: u32 = 0u;

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
    let near = frame.view_from_clip * vec4f(behind.at, 1.0, 1.0);
    let place = near.xyz / near.w;
    let towards = ray_through(place);
    var open = 1.0;
    if GROUND == 1u {
        open = open_ground(place, towards);
    }
    if BACKDROP == NOTHING {
        return vec4f(0.0, 0.0, 0.0, 1.0 - open);
    }
    return vec4f(min(light_from(behind.at, in_environment(towards)) * open, vec3f(65504.0)), 1.0);
}

fn light_from(at: vec2f, towards: vec3f) -> vec3f {
    switch BACKDROP {
        case ENVIRONMENT: {
            return textureSampleLevel(panorama, round_sampler, panorama_place(towards), 0.0).xyz * frame.environment.z;
        }
        case BLURRED: {
            return textureSampleLevel(reflections, smooth_sampler, towards, frame.blur).xyz * frame.environment.z;
        }
        default: {
            // Darker towards the corners, so that the eye rests on the model.
            return frame.backdrop.xyz * (1.0 - 0.45 * smoothstep(0.3, 1.5, length(at)));
        }
    }
}
