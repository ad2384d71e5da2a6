//! Renders the model's depth from a light, which passes what is clear.
//! @use view/corner view/maps view/veil

struct Caster {
    clip_from_view: mat4x4f,
    sample: f32,
    pad_1: f32,
    pad_2: f32,
    pad_3: f32,
}

@group(0) @binding(0) var<uniform> caster: Caster;

@vertex
fn place_corner(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return caster.clip_from_view * vec4f(position, 1.0);
}

struct Veiled {
    @builtin(position) clip: vec4f,
    @location(0) texel: vec2f,
    @location(1) @interpolate(flat) chart: u32,
}

@vertex
fn place_veiled(corner: Corner) -> Veiled {
    return Veiled(caster.clip_from_view * vec4f(corner.position, 1.0), corner.texel, corner.chart);
}

@fragment
fn pass_clear(veiled: Veiled) {
    if is_clear(Place(veiled.texel, i32(chart_row(veiled.chart).z)), veiled.clip.xy, caster.sample) {
        discard;
    }
}
