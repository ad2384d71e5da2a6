//! Numbers, textures and samplers that all shaders of a picture share: the camera, the light, and how the picture is shown.
//!
//! Places and directions are in view space: the model's box is centered and its largest side is 1; +Y is up.

struct Light {
    // Position with w 1, or the direction towards a far light with w 0.
    place: vec4f,
    // Radiance times solid angle of a far light, intensity of a near one; linear RGB. w is the first layer of its shadow,
    // where it has one.
    color: vec4f,
}

struct FrameUniforms {
    clip_from_view: mat4x4f,
    view_from_clip: mat4x4f,
    // Position of the camera with w 1; for parallel rays the direction towards it with w 0.
    eye: vec4f,
    // Irradiance over π of the environment in its own frame: factors of 1, x, y, z, xy, yz, zx, 3y² − 1 and x² − z² of a
    // normal.
    irradiance: array<vec4f, 9>,
    lights: array<Light, 4>,
    shadow_from_view: array<mat4x4f, 24>,
    // Height of the ground, and the radius around the vertical axis at which shade on it has faded out.
    ground: vec4f,
    // Light of a studio's backdrop, linear RGB.
    backdrop: vec4f,
    // Cosine and sine of the environment's turn about +Y, its strength, and the last level of its reflections.
    environment: vec4f,
    // Number of the picture's sample.
    sample: u32,
    // Level of the reflections that a blurred background shows.
    blur: f32,
    // Texels for one unit of UV, and the mean number of texels along a unit of view space.
    texels_of_uv: f32,
    even_density: f32,
    // The lowest and the highest height, working units.
    heights: vec2f,
    // View units in a working unit.
    view_from_working: f32,
    // Texels of the openness for one unit of UV.
    openness_size: f32,
}

@group(0) @binding(0) var<uniform> frame: FrameUniforms;
@group(0) @binding(1) var smooth_sampler: sampler;
@group(0) @binding(2) var reflections: texture_cube<f32>;
@group(0) @binding(3) var directional_albedo: texture_2d<f32>;
@group(0) @binding(4) var shadows: texture_depth_2d_array;
@group(0) @binding(5) var shadow_sampler: sampler_comparison;
// Share of the sky that is open above the ground, over a square of twice the radius around the vertical axis.
@group(0) @binding(6) var ground_openness: texture_2d<f32>;

const PI: f32 = 3.14159265358979;

// A direction in the frame of the environment's picture.
fn in_environment(direction: vec3f) -> vec3f {
    let turn = frame.environment.xy;
    return vec3f(turn.x * direction.x - turn.y * direction.z, direction.y, turn.y * direction.x + turn.x * direction.z);
}

// Where the camera's ray through a point of view space goes, away from the camera.
fn ray_through(place: vec3f) -> vec3f {
    return normalize(select(-frame.eye.xyz, place - frame.eye.xyz, frame.eye.w > 0.5));
}
