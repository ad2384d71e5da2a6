//! Renders the model's depth from a light.

struct Caster {
    clip_from_view: mat4x4f,
}

@group(0) @binding(0) var<uniform> caster: Caster;

@vertex
fn place_corner(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return caster.clip_from_view * vec4f(position, 1.0);
}
